// A trace on another machine than it was recorded on, where what that machine's memory brings sooner or later
// moves what follows. A trace does not say what needs what. What it shows is what cannot: a reference that
// was made before another's data were there did not need them. So it is replayed on the machine that it is of
// (exactly, replay.h), which says when all data were there; and each reference waits, on the other machine,
// for what had come before it was made in the run, and then for as long as it did there. What had come only
// just before may not have been needed either: threads of wide cores wait too often here. Which threads take
// which work is what it was in the run.
//
// Of a trace without its machine, each reference waits for all that its stream has read before.
#pragma once

#include "sim/replay/replay.h"

#include <deque>
#include <optional>
#include <queue>
#include <vector>

namespace sim {

class TimedReplay final : private ReplayListener {
public:
    /// `recorded_on`: the trace's machine, if it is known. Throws as Replay does.
    TimedReplay(const Config& config, const Config* recorded_on, const traces::Description& about,
                const ReplayOptions& options);
    void add(const traces::Block& block) { recorded_.add(block); }
    ReplayResult finish(const traces::Description& about);

private:
    struct Item {
        Performed what; // `ready` a cycle, from when that is known on
    };
    /// A reference whose data somebody may wait for.
    struct Fetch {
        cycle then, now; // when they were there, and when they are: a cycle or a ticket
    };
    struct Stream {
        std::deque<Item> items;
        std::size_t known = 0; // of these: when their data were there
        std::vector<Fetch> fetches;
        bool begun = false, waits = false, queued = false;
        cycle then = 0, now = 0; // of its latest reference
        cycle next = 0;          // its next one's, if it has a turn ...
        cycle hold = 0;          // ... and when there may be room for that
        std::int64_t lag() const { return static_cast<std::int64_t>(now - then); }
    };
    void performed(const Performed& p) override;
    void window(cycle begin) override;
    void ended(cycle t) override { end_ = t; }

    void learn_answers();
    void run(bool all);
    cycle limit() const;
    void line_up(std::uint32_t number);
    bool due(std::uint32_t number, cycle& t);
    void perform(std::uint32_t number);
    void come_to(cycle t);

    using Turn = std::pair<cycle, std::uint32_t>; // the earliest first, of equals the first stream

    bool knows_machine_;
    Replay recorded_;
    ReplayVocabulary vocabulary_;
    ReplayMachine machine_;
    std::vector<Stream> streams_;
    std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
    std::vector<std::uint32_t> waiting_; // for answers, or room
    cycle frontier_ = 0;                 // what is not known of the run yet came no earlier
    std::optional<cycle> end_;
    ReplayResult result_;
};

} // namespace sim
