// The memory system of a machine without the cores that run programs: its caches, network and memory, driven
// by references that come from elsewhere. All of it is the machine's own code (sim/memory, sim/machine,
// sim/network). Not modelled: translation of addresses (a trace has the walks that were made) and the L1s'
// ports (a trace has the cycles at which they were granted).
//
// A trace of what a level of caches passes on drives what lies below that level. The caches of the level are
// there, but only stand in for those of the run: levels below find in them what a trace says that they found
// (traces::Kind::recall).
//
// A trace of what memory is asked for drives memory alone, request by request, each when it came there; one
// of a level that tiles share does so over the network, on which nothing else is.
//
// In the reference mode what happens within a tile by itself happens when let_events_happen() says so, and in
// the windows of the run, as far as a trace and these events tell them.
#pragma once

#include "sim/machine/asides.h"
#include "sim/machine/beyond.h"
#include "sim/machine/report.h"
#include "sim/trace/passing.h"
#include "sim/trace/tile_progress.h"
#include "traces/description.h"
#include "traces/reference.h"

#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace sim {

/// What references of a class (traces::Class) do to a machine.
struct ReplayAction {
    /// Words go to the L2: changed there, or released (written). Spoken of at Part::aside.
    enum class What : std::uint8_t {
        read,
        write,
        change,
        release,
        prefetch,
        discard,
        invalidate,
        invalidate_all,
        pass,   // of what a level passes on
        nothing // the machine has no such thing
    };
    What what = What::nothing;
    traces::Kind kind = traces::Kind::read;
    traces::Part part = traces::Part::operation;
    bool modifies = false; // what is read is written, in the L1
    bool refused = false;  // in the run
    std::uint16_t structure = 0;
    std::uint32_t size = 0;
    std::size_t column = 0;
    std::uint64_t site = 0;
    std::uint32_t detail = 0; // sim/trace/passing.h
};

/// No time of a trace is later: clocks of memories are counted in picoseconds.
inline constexpr cycle latest_cycle = cycle{1} << 48U;

/// Of traces that do not say what lies where: names may still come.
inline constexpr std::size_t most_replayed_structures = 4096;

class ReplayMachine {
public:
    /// `labels`: of columns. Throws ConfigError where the machine cannot be replayed on.
    ReplayMachine(const Config& config, const traces::Description& about, Labels labels);

    /// That references may be of: threads, or caches of the trace's level.
    std::size_t streams() const { return seats_.size(); }
    /// The first level of caches that is driven, 0 for the L1; memory comes after the last.
    unsigned first_level() const { return level_; }
    /// Whether a trace is of what memory is asked for, or of what the caches that tiles share pass on:
    /// memory is driven alone.
    bool is_memory() const { return memory_; }
    std::uint64_t window_cycles() const { return window_cycles_; }
    cycle window_end() const { return window_end_; }
    /// No reference comes before this cycle any more.
    cycle earliest() const { return earliest_; }
    /// Whether structures are those that references name, not those of places in memory.
    bool by_reference() const { return by_reference_; }
    unsigned line_shift() const { return line_shift_; }

    /// The window until here; what was asked for in the one before is served as far as `served`.
    void open_window(cycle until, cycle served);
    /// ... the window that cycle `t` lies in, after all earlier ones.
    void come_to(cycle t);
    /// `accesses` of a line, or what else the action says, by a thread at `t`. Refused: ask again (Answer).
    /// `address` and `bytes`: of a discard all of it, which is more than a line.
    Answer perform(const ReplayAction& a, std::uint32_t thread, std::uint64_t address, std::uint32_t bytes,
                   std::uint32_t accesses, cycle t) {
        const Seat& s = seats_[thread];
        if (by_reference_)
            place(a, address);
        if (a.what <= ReplayAction::What::write) [[likely]] {
            if (strides_) [[unlikely]]
                note_site(*s.tile, a);
            return s.core->l1.access(address >> line_shift_, a.what == ReplayAction::What::write, accesses, t,
                                     a.column);
        }
        return perform_other(a, s, address, bytes, t);
    }
    std::size_t tiles() const { return tiles_.size(); }
    std::size_t tile_of(std::uint32_t stream) const { return seats_[stream].tile->number; }
    /// From when on a reference of this cycle may have been under way: a cache's came that much before.
    cycle begin_of(cycle t) const { return t - std::min(t, passing_latency_); }
    /// ... of a core's word, which comes to the L2 at this cycle.
    cycle begin_of_word(cycle t) const { return t - std::min(t, l1_latency_); }
    /// Of the reference mode: those of a stream's tile as far as cycle `t`, before what a thread does then.
    void let_events_happen(std::uint32_t stream, cycle t) {
        finish_events(*seats_[stream].tile, std::min(t + 1, window_end_));
    }
    /// ... as many as the trace of this machine says.
    void let_events_happen(std::uint32_t stream, const TileProgress& progress);
    /// Of the reference mode: the next of a stream's tile in the window at hand; false: there is none.
    bool let_one_event_happen(std::uint32_t stream);
    /// When a ticket that perform() gave is answered; false: not yet.
    bool find(std::uint32_t thread, cycle ticket, Answered& out) {
        return seats_[thread].tile->tickets.find(ticket, out);
    }
    /// All is served; caches stay as they are.
    void settle(cycle served);
    /// What a level that is not driven has written back at the end is served.
    void settle_level();
    /// After settle(): what lasts is written back from caches, at cycle `t`.
    void end_frame(cycle t);
    /// Nothing follows.
    Report finish();

private:
    struct Seat {
        Tile* tile;
        Core* core;
        std::size_t number; // of the core in its tile
        Cache* cache;       // whose stream it is
    };
    using SiteNumbers = std::unordered_map<std::uint64_t, std::uint32_t>; // by the trace's

    void place(const ReplayAction& a, std::uint64_t address) {
        if (LineMap::Line* line = lines_->line(address))
            line->place(a.structure);
    }
    void note_site(Tile& tile, const ReplayAction& a);
    Answer perform_other(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes,
                         cycle t);
    Answer pass(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes, cycle t);
    static Answer ask_in_vain(Passing::Asks asks, const Seat& s, Access access);
    void settle_stand_ins();
    void give_to_memory(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes,
                        cycle t);
    void send_to_memory(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes,
                        cycle t);
    void pass_word(const ReplayAction& a, const Seat& s, std::uint64_t address, cycle t);
    /// What is left in caches that stand in for others, which are empty then.
    template <class Visit> void each_stand_in(Visit visit) {
        if (level_ == 0 || is_memory())
            return;
        for (const Seat& s : seats_)
            s.cache->stand_down([&](std::uint64_t address, bool dirty) { visit(s, address, dirty); });
    }
    void finish_events(Tile& tile, cycle end);
    void finish_tile(Tile& tile);
    cycle next_event() const;
    cycle end_of_window_with(cycle next) const;
    void finish_window();
    void finish_windows(cycle served);
    void settle_tiles();
    void set_floors(cycle served);
    void discard(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes, cycle t);
    void serve(cycle end);
    void serve_all();
    bool lasts(std::uint64_t address) const;

    Config config_;
    Labels labels_;
    std::vector<traces::Description::Region> regions_;
    bool by_reference_, strides_;
    unsigned level_ = 0;
    bool memory_ = false;               // is driven alone
    bool of_shared_level_ = false;      // ... by what a level that tiles share passes on
    std::uint64_t passing_latency_ = 0; // of the level that a trace is of, if that is one of caches
    unsigned line_shift_, tile_levels_;
    std::uint64_t window_cycles_, reach_, shortest_answer_, shortest_line_, l1_latency_;
    std::optional<LineMap> lines_;
    std::unique_ptr<Beyond> beyond_;
    std::deque<Tile> tiles_;
    std::vector<Seat> seats_;        // by thread
    std::vector<SiteNumbers> sites_; // by tile
    cycle window_end_ = 0, earliest_ = 0, end_ = 0;
    std::uint64_t misplaced_ = 0, incoherent_ = 0;
};

} // namespace sim
