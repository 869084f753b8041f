#include "sim/replay/timed_replay.h"

#include "sim/config/error.h"
#include "sim/machine/windows.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sim {
namespace {

bool brings(const ReplayAction& a) {
    return a.what == ReplayAction::What::read || a.what == ReplayAction::What::change;
}

} // namespace

TimedReplay::TimedReplay(const Config& config, const Config* recorded_on, const traces::Description& about,
                         const ReplayOptions& options)
    : knows_machine_(recorded_on != nullptr),
      recorded_(knows_machine_ ? *recorded_on : config, about, options, this), vocabulary_(about, options),
      machine_(config, about, vocabulary_.labels()),
      streams_(std::min(machine_.streams(), recorded_.machine().streams())) {
    if (machine_.first_level() != 0)
        throw traces::Error("--timed: which reference waited for which is known of those of cores alone; "
                            "leave it out, or record the trace at level core");
    if (config.sim.mode != "fast")
        throw ConfigError("--timed: references move in the fast mode alone; give -g sim.mode=fast");
}

void TimedReplay::performed(const Performed& p) {
    if (p.stream >= streams_.size())
        throw traces::Error(
            fmt::format("the trace has a stream {}, but the machine {} threads, numbered from 0; "
                        "give a machine with more (-g chip.threads=..., chip.cores or "
                        "chip.tiles)",
                        p.stream, streams_.size()));
    Stream& s = streams_[p.stream];
    s.items.push_back({p});
    if (!knows_machine_)
        s.items.back().what.ready = p.at;
}

/// The run's machine has answered what it could.
void TimedReplay::learn_answers() {
    for (std::uint32_t n = 0; n < streams_.size(); ++n) {
        Stream& s = streams_[n];
        for (; s.known < s.items.size(); ++s.known) {
            cycle& ready = s.items[s.known].what.ready;
            if (Answered a; is_ticket(ready)) {
                if (!recorded_.machine().find(n, ready, a))
                    break;
                ready = std::max(a.last, s.items[s.known].what.at); // one of long ago may be forgotten
            }
        }
        if (s.known != 0 && !s.queued && !s.waits)
            line_up(n);
    }
}

void TimedReplay::window(cycle begin) {
    learn_answers();
    // Operations wait in issue windows, and what they ask for may come so much earlier than what is known.
    frontier_ = begin > booking_reach ? begin - booking_reach : 0;
    run(false);
}

/// Nobody whose next reference is not known yet makes one before, if they are no less behind the run than
/// those of whom one is known.
cycle TimedReplay::limit() const {
    constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
    std::int64_t known = none, others = none;
    for (const Stream& s : streams_)
        if (s.begun) {
            std::int64_t& least = s.known != 0 ? known : others;
            least = std::min(least, s.lag());
        }
    const std::int64_t least = known != none ? known : others != none ? others : 0;
    const std::int64_t limit = static_cast<std::int64_t>(frontier_) + least;
    return limit < 0 ? 0 : static_cast<cycle>(limit);
}

/// A stream with a reference gets its turn, or waits for what that needs.
void TimedReplay::line_up(std::uint32_t number) {
    Stream& s = streams_[number];
    if (s.known == 0 || s.queued)
        return;
    cycle t = 0;
    s.waits = !due(number, t);
    if (s.waits) {
        waiting_.push_back(number);
        return;
    }
    s.next = t;
    s.queued = true;
    turns_.push({t, number});
}

/// When the stream's next reference comes; false: what it waits for is not answered yet.
bool TimedReplay::due(std::uint32_t number, cycle& t) {
    Stream& s = streams_[number];
    const cycle then = s.items.front().what.at;
    cycle came = s.then; // the latest of what had come by then
    cycle least = 0;
    for (Fetch& f : s.fetches) {
        if (f.then > then)
            continue;
        if (Answered a; is_ticket(f.now)) {
            if (!machine_.find(number, f.now, a))
                return false;
            f.now = a.last;
        }
        came = std::max(came, f.then);
        least = std::max(least, f.now + (then - f.then));
    }
    if (!s.begun)
        t = then;
    else if (then >= came)
        t = s.now + (then - came);
    else // an earlier place in an issue window
        t = s.now - std::min(s.now, came - then);
    t = std::max({t, least, s.hold});
    return true;
}

void TimedReplay::come_to(cycle t) {
    machine_.come_to(t);
    std::vector<std::uint32_t> all;
    all.swap(waiting_);
    for (const std::uint32_t n : all)
        line_up(n);
}

/// The stream's next reference is made.
void TimedReplay::perform(std::uint32_t number) {
    Stream& s = streams_[number];
    const Performed& p = s.items.front().what;
    const cycle t = std::max(s.next, machine_.earliest());
    const Answer answer = machine_.perform(p.action, number, p.address, p.bytes, p.accesses, t);
    if (answer.refused) {
        ++result_.waits;
        const bool unknown = answer.ready == Answer::unknown;
        s.hold = unknown ? machine_.window_end() : std::max(answer.ready, t + 1);
        if (unknown) {
            s.waits = true;
            waiting_.push_back(number);
        } else {
            line_up(number);
        }
        return;
    }
    std::erase_if(s.fetches, [&](const Fetch& f) { return f.then <= p.at; });
    if (brings(p.action))
        s.fetches.push_back({p.ready, answer.ready});
    s.begun = true;
    s.then = p.at;
    s.now = t;
    s.hold = 0;
    result_.references += p.accesses;
    s.items.pop_front();
    --s.known;
    line_up(number);
}

void TimedReplay::run(bool all) {
    for (;;) {
        traces::check_interrupts();
        if (turns_.empty()) {
            if (waiting_.empty() || (!all && machine_.window_end() > limit()))
                return;
            come_to(machine_.window_end());
            continue;
        }
        const auto [t, number] = turns_.top();
        if (!all && t > limit())
            return;
        if (t >= machine_.window_end()) {
            // Who waits for an answer may have it earlier.
            come_to(waiting_.empty() ? t : machine_.window_end());
            continue;
        }
        turns_.pop();
        streams_[number].queued = false;
        perform(number);
    }
}

ReplayResult TimedReplay::finish(const traces::Description& about) {
    ReplayResult run_of = recorded_.finish(about); // answers all
    learn_answers();
    run(true);
    std::int64_t lag = 0;
    for (const Stream& s : streams_)
        lag = std::max(lag, s.lag());
    machine_.settle(machine_.window_end());
    result_.timed = true;
    result_.left_out = run_of.left_out;
    result_.ended = end_.has_value();
    result_.delay = static_cast<std::uint64_t>(lag);
    if (end_)
        machine_.end_frame(std::max(machine_.window_end(), *end_ + static_cast<cycle>(lag)));
    result_.report = machine_.finish();
    vocabulary_.name(about, result_.report);
    return std::move(result_);
}

} // namespace sim
