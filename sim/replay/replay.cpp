#include "sim/replay/replay.h"

#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "traces/error.h"
#include "traces/in_order.h"
#include "traces/io/interrupt.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

/// Of a machine's windows, in which references may lie this far ahead.
constexpr cycle far_ahead = cycle{1} << 24U;

/// Whether a trace says that it is all of a run on this machine.
bool is_of(const traces::Description& about, const Config& config) {
    if (!about.filters.empty() || about.sample != 1)
        return false;
    const std::optional<Config> own = machine_of(about);
    return own && alike(*own, config);
}

} // namespace

std::optional<Config> machine_of(const traces::Description& about) {
    if (about.configuration.empty() || about.window == 0)
        return std::nullopt;
    const std::string text = about.configuration.substr(0, about.configuration.find("\n# scene\n"));
    try {
        return parse_machine(text, "the trace's machine");
    } catch (const ConfigError&) {
        return std::nullopt; // of another program
    }
}

Replay::Replay(const Config& config, const traces::Description& about, const ReplayOptions& options,
               ReplayListener* listener)
    : vocabulary_(about, options), machine_(config, about, vocabulary_.labels()), listener_(listener),
      clocked_(about.time == "cycles" || about.time == "instructions" ||
               (about.time == "clocks" && machine_.is_memory())),
      following_(about.window == machine_.window_cycles() && !machine_.is_memory()),
      eventful_(config.sim.mode == "reference" && !machine_.is_memory()),
      tells_progress_(eventful_ && machine_.first_level() == 0 && is_of(about, config)),
      repeats_refused_(!eventful_ && !machine_.is_memory() && is_of(about, config)),
      from_zero_(following_ || (machine_.is_memory() && about.window != 0)), clocks_(about.time == "clocks"),
      clock_ps_(wide(config.memory.clock_ps)), cycle_ps_(wide(config.chip.clock_ps)) {}

void Replay::check(const traces::Block& block) const {
    const std::uint32_t last = block.segments.back().stream;
    if (last < machine_.streams())
        return;
    if (machine_.is_memory())
        throw traces::Error(fmt::format("the trace has requests of a tile {}, but the machine has {} tiles, "
                                        "numbered from 0; give a machine with more (-g chip.tiles=...)",
                                        last, machine_.streams()));
    if (machine_.first_level() == 0)
        throw traces::Error(
            fmt::format("the trace has a stream {}, but the machine {} threads, numbered from 0; "
                        "give a machine with more (-g chip.threads=..., chip.cores or "
                        "chip.tiles)",
                        last, machine_.streams()));
    throw traces::Error(fmt::format("the trace is of an L{} with number {}, but the machine has {} of them, "
                                    "numbered from 0; give a machine with more (chip.cores, chip.tiles)",
                                    machine_.first_level(), last, machine_.streams()));
}

/// Of the reference mode: until when each reference's tile had gone on by itself when it was made. Threads
/// act in order of time, but an operation's accesses have the cycles at which ports and banks took them,
/// which may be later: no later than any that follow in the window.
void Replay::find_acts(const traces::Block& block) {
    acts_.assign(block.times.begin(), block.times.end());
    std::vector<std::size_t> next;
    for (const traces::Segment& s : block.segments)
        next.push_back(s.begin);
    cycle begin = 0; // what a thread that waited does is later than that
    for (const traces::Turn& turn : block.order) {
        if (turn.what != traces::Turn::What::references)
            begin = turn.begin;
        for (std::uint32_t i = 0; i < turn.count; ++i) {
            cycle& act = acts_[next[turn.segment]++];
            act = std::max(machine_.begin_of(act), begin);
        }
    }
    std::vector<cycle> least(machine_.tiles(), ~cycle{0});
    for (auto turn = block.order.rbegin(); turn != block.order.rend(); ++turn) {
        if (turn->what != traces::Turn::What::references)
            std::fill(least.begin(), least.end(), ~cycle{0});
        for (std::uint32_t i = 0; i < turn->count; ++i) {
            cycle& l = least[machine_.tile_of(block.segments[turn->segment].stream)];
            cycle& act = acts_[--next[turn->segment]];
            act = l = std::min(l, act);
        }
    }
}

void Replay::add(const traces::Block& block) {
    check(block);
    learn(block.table);
    if (eventful_)
        find_acts(block);
    following_ = following_ && !block.order.empty();
    if (!begun_) {
        begun_ = true;
        origin_ = from_zero_ ? 0 : *std::min_element(block.times.begin(), block.times.end());
    }
    if (block.order.empty())
        return traces::each_in_time(
            block, [&](const traces::Segment& s, std::size_t i) { run(block, s.stream, i, i + 1); });
    std::vector<std::size_t> next;
    for (const traces::Segment& s : block.segments)
        next.push_back(s.begin);
    for (const traces::Turn& turn : block.order)
        if (turn.what == traces::Turn::What::references) {
            std::size_t& at = next[turn.segment];
            run(block, block.segments[turn.segment].stream, at, at + turn.count);
            at += turn.count;
        } else {
            mark(turn);
        }
}

/// A window or the end, as the trace has it.
void Replay::mark(const traces::Turn& turn) {
    if (machine_.is_memory()) { // which goes on until it has all that it was asked for
        result_.ended = result_.ended || turn.what == traces::Turn::What::end;
        return;
    }
    if (turn.what == traces::Turn::What::end) {
        if (result_.ended) // and of a level above those that are driven, what it wrote back then
            return machine_.settle_level();
        machine_.settle(following_ ? turn.begin : machine_.window_end());
        const cycle end = std::max(turn.until, origin_) - origin_ + offset_;
        if (listener_ != nullptr)
            listener_->ended(end);
        result_.ended = true;
        end_ = end;
        if (machine_.first_level() == 0)
            machine_.end_frame(end_);
        return;
    }
    const bool fits = turn.until > machine_.window_end() - machine_.window_cycles() &&
                      turn.begin < turn.until && turn.until < latest_cycle;
    following_ = following_ && fits;
    if (!following_)
        return;
    machine_.open_window(turn.until, turn.begin);
    if (listener_ != nullptr)
        listener_->window(turn.begin);
}

void Replay::come_to(cycle t) {
    machine_.come_to(t);
    if (listener_ != nullptr)
        listener_->window(machine_.window_end() - machine_.window_cycles());
}

void Replay::tell(const ReplayAction& a, std::uint32_t stream, std::uint64_t address, std::uint32_t bytes,
                  std::uint32_t accesses, cycle t, const Answer& answer) {
    listener_->performed({a, stream, bytes, accesses, address, t - std::min(t, offset_), answer.ready});
}

/// The next reference comes at this cycle, which no window that is open holds.
void Replay::pass_window(cycle t, std::uint64_t time) {
    if (t >= latest_cycle)
        throw traces::Error(
            fmt::format("a reference has the time {}, beyond all that is simulated; the trace's "
                        "times begin at {}",
                        time, origin_));
    following_ = following_ && t < machine_.window_end() + far_ahead;
    if (!following_)
        come_to(t);
}

/// ... after the trace's origin.
inline cycle Replay::cycle_of(std::uint64_t time) const {
    const std::uint64_t since = time - std::min(time, origin_);
    if (!clocks_) [[likely]]
        return since;
    if (since >= latest_cycle)
        return latest_cycle;
    return since / cycle_ps_ * clock_ps_ + since % cycle_ps_ * clock_ps_ / cycle_ps_;
}

/// The cycle of the next reference, whose window is open. Words that threads share pass by the L1, whose
/// latency may lie before all that may still come.
inline cycle Replay::arrive(std::uint64_t time, const ReplayAction& a) {
    const cycle t = (clocked_ ? cycle_of(time) : result_.references) + offset_;
    if (t >= machine_.window_end()) [[unlikely]]
        pass_window(t, time);
    const cycle earliest = machine_.earliest();
    return std::max(t, a.what == ReplayAction::What::change ? machine_.begin_of_word(earliest) : earliest);
}

inline void Replay::perform(const ReplayAction& a, std::uint32_t stream, std::uint64_t address,
                            std::uint32_t bytes, std::uint32_t accesses, cycle t) {
    const Answer answer = machine_.perform(a, stream, address, bytes, accesses, t);
    if (answer.refused) [[unlikely]]
        insist(a, stream, address, bytes, accesses, t, answer);
    else if (listener_ != nullptr) [[unlikely]]
        tell(a, stream, address, bytes, accesses, t, answer);
}

/// ... of a reference at cycle `t`: what the trace of this machine says, else as far as it had come when it
/// was made.
void Replay::let_events_happen(const ReplayAction& a, std::uint32_t stream, cycle t, cycle acted) {
    const TileProgress progress(a.detail, t);
    if (tells_progress_ && progress.told())
        machine_.let_events_happen(stream, progress);
    else
        machine_.let_events_happen(stream, acted);
}

/// References of a stream, one after the other.
void Replay::run(const traces::Block& block, std::uint32_t stream, std::size_t begin, std::size_t end) {
    const bool compacts = machine_.by_reference() && !machine_.is_memory(); // of a DRAM any has a place
    const unsigned shift = machine_.line_shift();
    for (std::size_t i = begin; i < end;) {
        traces::check_interrupts();
        const std::uint32_t number = block.classes[i];
        const ReplayAction& a = actions_[number];
        const std::uint64_t low = compacts ? compact_(block.addresses[i]) : block.addresses[i];
        const cycle t = arrive(block.times[i], a);
        if (eventful_ && a.kind != traces::Kind::recall) [[unlikely]] // which is found by what follows
            let_events_happen(a, stream, t, acts_[i] + offset_);
        if (a.refused) [[unlikely]] {
            if (repeats_refused_)
                machine_.perform(a, stream, low, std::max(a.size, 1U), 1, t);
            ++i;
            continue;
        }
        std::size_t n = 1;
        while (i + n < end && goes_on_[block.classes[i + n]] == leads_[number])
            ++n;
        const std::uint64_t last = block.addresses[i + n - 1]; // beyond the last of all there is none
        const std::uint32_t size = std::max(actions_[block.classes[i + n - 1]].size, 1U);
        const std::uint64_t high =
            low + (last - block.addresses[i]) + std::min<std::uint64_t>(size - 1, ~last);
        i += n;
        const auto accesses = static_cast<std::uint32_t>(n);
        if (a.what > ReplayAction::What::write || a.modifies || low >> shift != high >> shift) [[unlikely]] {
            if (a.what == ReplayAction::What::nothing) {
                if (machine_.first_level() != 0) // it asked nothing of the levels below
                    continue;
                result_.left_out[static_cast<std::size_t>(a.kind)] += n;
                continue;
            }
            result_.references += n;
            touch(a, stream, low, high, accesses, t);
            continue;
        }
        result_.references += n;
        const auto bytes = static_cast<std::uint32_t>(high - low + 1);
        perform(a, stream, low, bytes, accesses, t);
    }
}

/// Which references go on with what the one before them began: pieces of an access, lines of a discard.
void Replay::learn(const std::vector<traces::Class>& table) {
    vocabulary_.learn(table, actions_);
    goes_on_.clear();
    leads_.clear();
    for (const ReplayAction& a : actions_) {
        const bool discards = a.what == ReplayAction::What::discard;
        const bool more = discards ? a.part == traces::Part::access : a.part == traces::Part::piece;
        const auto what = static_cast<std::uint8_t>(static_cast<unsigned>(a.what) + 1);
        goes_on_.push_back(more ? what : std::uint8_t{0});
        leads_.push_back(what);
    }
}

void Replay::touch(const ReplayAction& a, std::uint32_t stream, std::uint64_t low, std::uint64_t high,
                   std::uint32_t accesses, cycle t) {
    const unsigned shift = machine_.line_shift();
    if (a.modifies) [[unlikely]] {
        touch_lines(a, stream, low, high, t);
        ReplayAction writes = a;
        writes.what = ReplayAction::What::write;
        writes.part = traces::Part::access;
        return touch_lines(writes, stream, low, high, std::max(t, machine_.earliest()));
    }
    if (a.what <= ReplayAction::What::write && low >> shift != high >> shift) [[unlikely]]
        return touch_lines(a, stream, low, high, t);
    const auto bytes = static_cast<std::uint32_t>(high - low + 1);
    perform(a, stream, low, bytes, accesses, t);
}

/// An access of each line.
void Replay::touch_lines(const ReplayAction& a, std::uint32_t stream, std::uint64_t low, std::uint64_t high,
                         cycle t) {
    const std::uint64_t line_bytes = std::uint64_t{1} << machine_.line_shift();
    ReplayAction each = a;
    for (std::uint64_t at = low, last = 0; at >= last && at <= high; at = (last | (line_bytes - 1)) + 1) {
        traces::check_interrupts();
        last = at;
        const auto bytes = static_cast<std::uint32_t>(std::min(high, at | (line_bytes - 1)) - at + 1);
        t = std::max(t, machine_.earliest());
        perform(each, stream, at, bytes, 1, t);
        if (each.part == traces::Part::operation)
            each.part = traces::Part::access;
    }
}

/// Until there is room for it, time passes for all.
void Replay::insist(const ReplayAction& a, std::uint32_t stream, std::uint64_t address, std::uint32_t bytes,
                    std::uint32_t accesses, cycle t, const Answer& refused) {
    ++result_.waits;
    Answer answer = refused;
    if (eventful_) // in the run it heard of room at that cycle, and no other reference waited
        answer = wait_for_room(a, stream, address, bytes, accesses, t);
    following_ = following_ && eventful_;
    while (answer.refused) {
        const cycle next =
            std::max(answer.ready == Answer::unknown ? machine_.window_end() : answer.ready, t + 1);
        offset_ += next - t;
        result_.delay += next - t;
        t = next;
        if (t >= machine_.window_end())
            come_to(t);
        answer = machine_.perform(a, stream, address, bytes, accesses, t);
    }
    if (listener_ != nullptr)
        tell(a, stream, address, bytes, accesses, t, answer);
}

Answer Replay::wait_for_room(const ReplayAction& a, std::uint32_t stream, std::uint64_t address,
                             std::uint32_t bytes, std::uint32_t accesses, cycle& t) {
    for (;;) {
        if (!machine_.let_one_event_happen(stream) && ++t >= machine_.window_end())
            come_to(t);
        const Answer answer = machine_.perform(a, stream, address, bytes, accesses, t);
        if (!answer.refused)
            return answer;
    }
}

ReplayResult Replay::finish(const traces::Description& about) {
    if (!result_.ended || machine_.is_memory())
        machine_.settle(machine_.window_end());
    else if (machine_.first_level() != 0)
        machine_.end_frame(end_);
    result_.first_level = machine_.first_level();
    result_.memory_alone = machine_.is_memory();
    result_.windows = following_ && begun_;
    result_.report = machine_.finish();
    vocabulary_.name(about, result_.report);
    return std::move(result_);
}

} // namespace sim
