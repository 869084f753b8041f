// A trace on a machine, reference by reference in the order in which they were made: that which a trace says
// (traces::Turn), else that of its times. Each comes at the cycle at which it was recorded, whatever earlier
// ones have brought; where the machine has no room for one (an MSHR), it and all that follow come so much
// later. On the machine that a trace of its cores, or of what a level of caches in its tiles passed on, was
// recorded on, from cold caches, nothing has to wait, and all that the memory system counts is what the run
// counted. (What memory was asked for has no windows: each request comes when it came there, in either mode.)
// In the reference mode, in which caches within tiles act in order of time, that is so of cores, whose traces
// tell how far a tile had gone on by itself at each reference (tile_progress.h). Those of its caches do not,
// nor is it so on another machine: there what happened between two accesses of one operation, and when a
// reference waited for room in an L1, is what counts may be off by.
//
// Times that are no cycles or instructions do not count: references come one a cycle. Clocks of memory count
// where memory alone is driven.
#pragma once

#include "sim/replay/addresses.h"
#include "sim/replay/replay_machine.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace sim {

struct ReplayOptions {
    bool fetches = false; // fetches of instructions are reads, of a unified cache; else they are left out
};

struct ReplayResult {
    /// What the memory system counted; of cores, threads and instructions it says nothing.
    Report report;
    std::uint64_t references = 0; // replayed
    std::array<std::uint64_t, traces::kind_names.size()>
        left_out{};                     // by kind: what the machine does not have
    std::uint64_t waits = 0, delay = 0; // references that found no room, and cycles that all was delayed by
    bool windows = false;               // the run's own windows of time were followed to the end
    bool timed = false;                 // each came when what it waited for was there (timed_replay.h)
    unsigned first_level = 0;           // of caches that is driven, 0 for the L1; those above are in no trace
    bool memory_alone = false; // no cache is driven, and of the network only the way to memory, if any
    bool ended = false;        // the trace says when it was over, and what lasts was written back then
};

/// What a trace is to a machine: which columns its phases and work count under, what its classes do.
class ReplayVocabulary {
public:
    ReplayVocabulary(const traces::Description& about, const ReplayOptions& options);
    const Labels& labels() const { return labels_; }
    /// Of a block's classes. Throws traces::Error where a table has grown too long.
    void learn(const std::vector<traces::Class>& table, std::vector<ReplayAction>& actions) const;
    /// Names that tables have got since.
    void name(const traces::Description& about, Report& report) const;

private:
    ReplayOptions options_;
    std::string level_; // that the trace is of, where that is one of caches
    bool by_work_;      // else by phases alone
    std::size_t phases_;
    Labels labels_;
};

/// The machine that a trace says it is of, if it does.
std::optional<Config> machine_of(const traces::Description& about);

/// Hears what a replay does.
class ReplayListener {
public:
    ReplayListener() = default;
    ReplayListener(const ReplayListener&) = delete;
    ReplayListener& operator=(const ReplayListener&) = delete;
    virtual ~ReplayListener() = default;

    struct Performed {
        ReplayAction action;
        std::uint32_t stream, bytes, accesses;
        std::uint64_t address;
        cycle at, ready; // ready: a cycle, or a ticket (ReplayMachine::find)
    };
    virtual void performed(const Performed& p) = 0;
    /// What was asked for in the window before is answered, as far as it can be; the next begins at this
    /// cycle.
    virtual void window(cycle begin) = 0;
    /// The trace is over at this cycle.
    virtual void ended(cycle t) = 0;
};

class Replay {
public:
    /// Throws ConfigError where the machine cannot be replayed on, traces::Error where the trace cannot.
    Replay(const Config& config, const traces::Description& about, const ReplayOptions& options,
           ReplayListener* listener = nullptr);
    ReplayMachine& machine() { return machine_; }
    /// The next of the trace. Throws traces::Error, traces::Interrupted.
    void add(const traces::Block& block);
    /// No more comes. `about`: with all names.
    ReplayResult finish(const traces::Description& about);

private:
    void check(const traces::Block& block) const;
    void find_acts(const traces::Block& block);
    void learn(const std::vector<traces::Class>& table);
    void run(const traces::Block& block, std::uint32_t stream, std::size_t begin, std::size_t end);
    void let_events_happen(const ReplayAction& a, std::uint32_t stream, cycle t, cycle acted);
    void touch(const ReplayAction& a, std::uint32_t stream, std::uint64_t low, std::uint64_t high,
               std::uint32_t accesses, cycle t);
    void touch_lines(const ReplayAction& a, std::uint32_t stream, std::uint64_t low, std::uint64_t high,
                     cycle t);
    inline void perform(const ReplayAction& a, std::uint32_t stream, std::uint64_t address,
                        std::uint32_t bytes, std::uint32_t accesses, cycle t);
    void insist(const ReplayAction& a, std::uint32_t stream, std::uint64_t address, std::uint32_t bytes,
                std::uint32_t accesses, cycle t, const Answer& refused);
    Answer wait_for_room(const ReplayAction& a, std::uint32_t stream, std::uint64_t address,
                         std::uint32_t bytes, std::uint32_t accesses, cycle& t);
    cycle cycle_of(std::uint64_t time) const;
    cycle arrive(std::uint64_t time, const ReplayAction& a);
    void pass_window(cycle t, std::uint64_t time);
    void come_to(cycle t);
    void tell(const ReplayAction& a, std::uint32_t stream, std::uint64_t address, std::uint32_t bytes,
              std::uint32_t accesses, cycle t, const Answer& answer);
    void mark(const traces::Turn& turn);

    ReplayVocabulary vocabulary_;
    ReplayMachine machine_;
    ReplayListener* listener_; // or null
    CompactAddresses compact_;
    std::vector<ReplayAction> actions_;         // of the block at hand, by class
    std::vector<cycle> acts_;                   // likewise, by reference
    std::vector<std::uint8_t> goes_on_, leads_; // likewise: equal where one goes on with the other
    bool clocked_, following_;                  // times are cycles; the run's windows are followed
    bool eventful_;                             // the machine is in the reference mode
    bool tells_progress_;                       // ... and the trace's own, of whose cores it is
    bool repeats_refused_;                      // it is the trace's own, in the fast mode
    bool from_zero_;                            // times are the run's
    bool clocks_;                               // ... or clocks of memory, of which each is
    std::uint64_t clock_ps_, cycle_ps_;         // so many picoseconds, and a cycle
    bool begun_ = false;
    cycle end_ = 0;
    std::uint64_t origin_ = 0, offset_ = 0;
    ReplayResult result_;
};

} // namespace sim
