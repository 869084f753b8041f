#include "sim/machine/engine.h"

#include "sim/config/placement.h"

#include <fmt/core.h>

#include <bit>
#include <cstdio>
#include <cstdlib>

namespace sim {

Engine* running_engine = nullptr;
Hart* running_hart = nullptr;

void calendar_too_short(const char* name, std::uint64_t slot, std::uint64_t ring) {
    fmt::print(
        stderr,
        "razor-sim: broken invariant: the calendar of {} spans {} slots and was asked for slot {}, which it "
        "has passed\n",
        name, ring, slot);
    std::abort();
}

void Engine::outside(const void* p) {
    fmt::print(stderr, "razor-sim: broken invariant: a kernel touched {}, which is not in frame memory\n", p);
    std::abort();
}

namespace {

/// While a thread lets others run: whoever comes back is the one that left, also when it is being unwound.
class Away {
public:
    Away() = default;
    Away(const Away&) = delete;
    Away& operator=(const Away&) = delete;
    ~Away() { running_hart = self_; }

private:
    Hart* self_ = running_hart;
};

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}
std::uint32_t narrow(integer x) {
    return static_cast<std::uint32_t>(x);
}
unsigned log2(integer x) {
    return static_cast<unsigned>(std::countr_zero(wide(x)));
}

std::uint64_t to_core_cycles(const Config& c, integer memory_clocks) {
    return wide((memory_clocks * c.memory.clock_ps + c.chip.clock_ps - 1) / c.chip.clock_ps);
}

/// The longest that a request can wait behind all that can be outstanding at once (what MSHRs and buffers
/// hold, and one gather or scatter of every thread, each line of which evicts another), all for one bank.
std::uint64_t longest_wait(const Config& c) {
    integer outstanding = c.chip.cores * (c.l1.mshrs + c.l1.write_back_buffer) + c.l2.mshrs +
                          c.l2.write_back_buffer + 2 * c.chip.cores * c.chip.threads * integer{width};
    integer on_chip =
        c.l1.latency + c.l2.latency + c.memory.controller_cycles + c.coherence.visibility_cycles;
    auto service = static_cast<integer>(Memory::longest_service(c, wide(outstanding)));
    return to_core_cycles(c, service) + wide(on_chip) +
           wide(outstanding * (c.l1.line_bytes / c.l2.bank_bytes + 1));
}

/// How far behind its latest turn an operation may issue: younger operations of a window are simulated after
/// older ones that had to wait. What the window would let issue earlier still issues then.
std::uint64_t reach_cycles(const Config& c) {
    return c.core.window == 1 ? 0 : std::min<std::uint64_t>(65536, wide(c.core.window) * longest_wait(c));
}

/// The cycles between the operation that acts now and the farthest booking of a core's resources.
std::uint64_t ring_cycles(const Config& c) {
    std::uint64_t own =
        wide(c.chip.threads) * 64 * wide(*std::max_element(c.interval.begin(), c.interval.end())) + 4096;
    return wide(c.sim.quantum) + own + reach_cycles(c);
}

} // namespace

Engine::Engine(const Config& config, const isa::address_space& space, int workers,
               const std::vector<std::string>& phases, const std::function<void(int)>& worker)
    : config_(config), pieces_(std::max(1U, width / narrow(config.core.lanes))),
      piece_lanes_(width / pieces_),
      span_((pieces_ + narrow(config.core.issue_width) - 1) / narrow(config.core.issue_width)),
      issue_shift_(Calendar::log2_group(narrow(config.core.issue_width))),
      port_shift_(Calendar::log2_group(narrow(config.l1.ports))), port_bytes_(narrow(config.l1.port_bytes)),
      line_bytes_(narrow(config.l1.line_bytes)), line_shift_(log2(config.l1.line_bytes)),
      overhead_(static_cast<std::uint32_t>(config.core.scalar_overhead * 1024.0 + 0.5)),
      registers_(config.core.vector_registers > 0), lane_gather_(config.core.gather == "lane"),
      hold_policy_(config.core.switch_policy == "stall"),
      prediction_(config.core.predictor == "none"      ? Prediction::none
                  : config.core.predictor == "perfect" ? Prediction::perfect
                                                       : Prediction::counters),
      base_(space.base()), reach_(config.core.window == 1 ? ~std::uint64_t{0} : reach_cycles(config)),
      ring_(ring_cycles(config)), space_(space), attribution_(space, std::max<std::size_t>(1, phases.size())),
      memory_(config,
              ring_ * wide(config.chip.clock_ps) / wide(config.memory.clock_ps) + longest_wait(config)),
      l2_(config, ring_ + longest_wait(config), memory_, attribution_),
      scheduler_(wide(config.sim.quantum), wide(config.sim.stack_kib) * 1024), workers_(workers),
      phases_(phases.empty() ? std::vector<std::string>{"all"} : phases) {
    for (std::size_t i = 0; i < class_count; ++i) {
        latency_[i] = narrow(config.latency[i]);
        interval_[i] = narrow(config.interval[i]);
    }
    std::uint64_t spill_bytes = wide(config.core.spill_slots) * width * 4;
    spill_bytes = (spill_bytes + 4095) / 4096 * 4096;
    for (integer c = 0; c < config.chip.cores; ++c) {
        cores_.emplace_back(config, ring_, l2_, attribution_);
        for (integer t = 0; t < config.chip.threads; ++t) {
            auto number = static_cast<std::uint32_t>(harts_.size());
            harts_.emplace_back(number, cores_.back(), config, phases_.size());
            harts_.back().spill_base = attribution_.spill_begin() + number * spill_bytes;
        }
    }
    std::vector<int> placed(harts_.size(), -1);
    const Placement placement(config.chip);
    for (int w = 0; w < workers; ++w)
        placed[static_cast<std::size_t>(placement.number(placement.of(w)))] = w;
    for (Hart& h : harts_) {
        h.worker = placed[h.number];
        if (h.worker >= 0)
            scheduler_.add(h.number, [&h, worker] {
                running_hart = &h;
                worker(h.worker);
            });
    }
}

Report Engine::run() {
    scheduler_.run([this] { return describe_deadlock(); });
    for (Hart& h : harts_)
        if (h.complete.at() > h.accounted) {
            h.account(h.accounted, h.complete.at(), h.complete.why());
            h.accounted = h.complete.at();
        }
    memory_.finish();
    return report(workers_, phases_);
}

std::string Engine::describe_deadlock() const {
    std::string who;
    for (const Hart* h : sleepers_) {
        auto offset = static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(h->waits_for) - base_);
        const isa::region* r = space_.find(offset);
        who += fmt::format("{}worker {} since cycle {} for a word of {}", who.empty() ? "" : ", ", h->worker,
                           h->acting.at(), r == nullptr ? "unknown memory" : r->structure);
        if (who.size() > 400) {
            who += ", ...";
            break;
        }
    }
    return fmt::format("deadlock: nobody is left to write what the others wait for: {}", who);
}

// --- order and issue
// --------------------------------------------------------------------------------------------------

/// Returns when the other threads have come as far as cycle `t` of this one.
inline cycle Engine::turn(Hart& h, cycle t) {
    Scheduler::Key k = Scheduler::key(t, h.number);
    if (k > scheduler_.horizon()) {
        Away away;
        scheduler_.yield(k);
        if (t > reach_)
            h.bound.later(Due(t - reach_, Cause::slots));
    }
    h.now = std::max(h.now, t);
    return t;
}

/// Policy stall: the cycle from which this thread holds its core. It waits until the holder has not issued
/// for a cycle.
cycle Engine::hold_core(Hart& h, cycle t) {
    Core& core = *h.core;
    while (core.running != &h && core.running != nullptr && core.busy_until >= t)
        t = turn(h, core.busy_until + 1);
    if (core.running != &h) {
        if (core.running != nullptr) {
            ++h.counters.switches;
            t += wide(config_.core.switch_cycles);
        }
        core.running = &h;
    }
    return t;
}

inline Issued Engine::issue(Hart& h, int kind, std::uint32_t instructions, Due ready) {
    Core& core = *h.core;
    cycle t = turn(h, ready.at());
    if (hold_policy_)
        t = hold_core(h, t);
    Issued at{};
    std::uint32_t interval = interval_[static_cast<std::size_t>(kind)];
    if (interval == 1) {
        Calendar::Span s = core.issue.take(t << issue_shift_, instructions);
        at = {s.first >> issue_shift_, s.last >> issue_shift_};
    } else {
        Calendar& unit = *core.units[static_cast<std::size_t>(kind)];
        for (std::uint32_t i = 0; i < instructions; ++i) {
            cycle begin = unit.take_run(t, interval);
            at.last = core.issue.take(begin << issue_shift_) >> issue_shift_;
            at.first = i == 0 ? at.last : at.first;
            t = begin + interval;
        }
    }
    if (hold_policy_)
        core.busy_until = std::max(core.busy_until, at.last + 1);
    h.counters.instructions += instructions;
    h.phase_instructions[h.phase] += instructions;
    if (at.first > h.accounted) {
        cycle stalled = std::min(std::max(ready.at(), h.accounted), at.first);
        h.account(h.accounted, stalled, ready.why());
        h.account(stalled, at.first, Cause::slots);
        h.accounted = at.first;
    }
    if (at.last >= h.accounted) {
        auto width_of_issue = static_cast<std::uint32_t>(config_.core.issue_width);
        cycle least = (instructions + width_of_issue - 1) / width_of_issue;
        cycle busy = std::min<cycle>(least, at.last + 1 - h.accounted);
        h.account(h.accounted, h.accounted + busy, Cause::busy);
        h.account(h.accounted + busy, at.last + 1, Cause::slots);
        h.accounted = at.last + 1;
    }
    return at;
}

/// Ends an operation: later ones count from it (rule 2). A miss that waited for an MSHR left the pipeline
/// only then.
inline void Engine::finish_issue(Hart& h, Issued at, cycle granted) {
    Due& slot = h.window[h.position];
    h.bound.later(slot);
    if (granted > at.last)
        h.bound.later(Due(granted, Cause::mshrs));
    slot = Due(at.last, Cause::busy);
    if (++h.position == h.window.size())
        h.position = 0;
}

inline void Engine::count(Hart& h, std::uint32_t instructions, bool vector) {
    ++h.counters.vops;
    ++h.phase_vops[h.phase];
    if (vector) {
        ++h.counters.vector_vops;
        h.counters.lane_slots += static_cast<std::uint64_t>(instructions) * piece_lanes_;
    }
}

inline void Engine::charge_overhead(Hart& h, Due ready) {
    if (overhead_ == 0)
        return;
    h.overhead += overhead_;
    std::uint32_t whole = h.overhead / 1024;
    h.overhead %= 1024;
    if (whole == 0)
        return;
    h.counters.overhead_instructions += whole;
    issue(h, 0, whole, ready);
}

stamp Engine::compute(Hart& h, int kind, std::uint32_t instructions, Due ready, bool vector) {
    if (kind == static_cast<int>(operation::broadcast))
        instructions = 1; // all registers of the value are the same one
    Issued at = issue(h, kind, instructions, ready);
    finish_issue(h, at, 0);
    count(h, instructions, vector || instructions > 1);
    std::uint32_t latency = latency_[static_cast<std::size_t>(kind)];
    stamp r;
    r.last = at.last + latency;
    r.first = vector ? at.first + latency : r.last;
    r.cause = static_cast<std::uint8_t>(Cause::compute);
    r.value = vector ? h.registers.make() : 0;
    h.complete.later(Due(r.last, Cause::compute));
    return r;
}

void Engine::branch(Hart& h, site where, Due ready, bool taken) {
    charge_overhead(h, begin(h));
    Issued at = issue(h, branch_class, 1, ready);
    finish_issue(h, at, 0);
    count(h, 1, false);
    ++h.counters.branches;
    cycle known = at.last + latency_[branch_class];
    h.complete.later(Due(known, Cause::compute));
    if (prediction_ == Prediction::perfect)
        return;
    if (prediction_ == Prediction::none) {
        h.bound.later(Due(known, Cause::branch));
    } else if (!h.core->predictor.right(sites_.number(where), h.history, taken)) {
        ++h.counters.mispredicts;
        h.bound.later(Due(known + wide(config_.core.mispredict_cycles), Cause::branch));
    }
}

/// Rule 3: a register that was not kept comes back through the L1, stored first if it never was.
void Engine::reload(Hart& h, Due& ready, std::uint32_t value, bool unstored) {
    std::uint64_t place = h.spill_base + value % wide(config_.core.spill_slots) * (width * 4);
    std::uint64_t all = ~std::uint64_t{0} >> (64 - width);
    Due now = begin(h);
    if (unstored) {
        ++h.counters.spill_stores;
        Issued at = issue(h, 0, pieces_, now);
        stored(h, touch_lanes(h, place, all, true, at.first));
    }
    ++h.counters.spill_loads;
    Issued at = issue(h, 0, pieces_, now);
    Data data = touch_lanes(h, place, all, false, at.first);
    cycle follow = data.last > span_ - 1 ? data.last - (span_ - 1) : 0;
    ready.later(Due(std::max(data.first, follow), Cause::spill));
}

// --- memory
// -----------------------------------------------------------------------------------------------------------

inline void Engine::touch_line(Hart& h, std::uint64_t line, bool write, std::uint32_t accesses,
                               std::uint32_t slots, cycle from, Data& data) {
    Core& core = *h.core;
    Calendar::Span s = core.ports.take(from << port_shift_, slots);
    core.l1.counters().busy_cycles += slots;
    Answer a = core.l1.access(line, write, accesses, s.first >> port_shift_, h.phase);
    cycle last = std::max(a.ready, (s.last >> port_shift_) + wide(config_.l1.latency));
    data.first = std::min(data.first, a.ready);
    if (last > data.last) {
        data.last = last;
        data.from = a.from;
    }
    data.granted = std::max(data.granted, a.granted);
}

/// One machine access.
inline void Engine::touch(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write, cycle from,
                          Data& data) {
    std::uint32_t slots = (bytes + port_bytes_ - 1) / port_bytes_;
    for (std::uint64_t line = address >> line_shift_; line <= (address + bytes - 1) >> line_shift_; ++line)
        touch_line(h, line, write, 1, slots, from, data);
}

/// Consecutive lanes: an access for each machine instruction with a lane that is on, and each line it
/// touches.
Engine::Data Engine::touch_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, bool write,
                                 cycle from) {
    Data data;
    std::uint32_t bytes = piece_lanes_ * 4;
    std::uint32_t slots = (std::min(bytes, line_bytes_) + port_bytes_ - 1) / port_bytes_;
    std::uint64_t piece_mask = ~std::uint64_t{0} >> (64 - piece_lanes_);
    std::uint64_t run_line = 0;
    std::uint32_t run = 0;
    for (std::uint32_t i = 0; i < pieces_; ++i) {
        std::uint64_t on = lanes >> (i * piece_lanes_) & piece_mask;
        if (on == 0)
            continue;
        std::uint64_t piece = address + i * bytes;
        std::uint64_t low = (piece + 4 * static_cast<unsigned>(std::countr_zero(on))) >> line_shift_;
        std::uint64_t high =
            (piece + 4 * static_cast<unsigned>(63 - std::countl_zero(on)) + 3) >> line_shift_;
        for (std::uint64_t line = low; line <= high; ++line) {
            if (run != 0 && line != run_line) {
                touch_line(h, run_line, write, run, run * slots, from, data);
                run = 0;
            }
            run_line = line;
            ++run;
        }
    }
    if (run != 0)
        touch_line(h, run_line, write, run, run * slots, from, data);
    return data;
}

/// Lanes anywhere: for each machine instruction every distinct line once, or (core.gather = "lane") every
/// lane.
Engine::Data Engine::touch_indexed(Hart& h, std::uint64_t address, const std::int32_t* index,
                                   std::uint64_t lanes, bool write, cycle from) {
    Data data;
    auto line_of = [&](std::uint32_t lane) {
        return (address + static_cast<std::uint64_t>(std::int64_t{index[lane]} * 4)) >> line_shift_;
    };
    for (std::uint32_t i = 0; i < width; i += piece_lanes_) {
        std::uint64_t seen[64];
        std::uint32_t distinct = 0;
        for (std::uint32_t lane = i; lane < i + piece_lanes_; ++lane) {
            if ((lanes >> lane & 1U) == 0)
                continue;
            std::uint64_t line = line_of(lane);
            bool known = !lane_gather_ && std::find(seen, seen + distinct, line) != seen + distinct;
            if (!known)
                seen[distinct++] = line;
        }
        for (std::uint32_t k = 0; k < distinct; ++k)
            touch_line(h, seen[k], write, 1, 1, from, data);
    }
    return data;
}

inline std::uint32_t Engine::indexed_instructions(std::uint64_t lanes) const {
    return lane_gather_ ? std::max(1U, static_cast<std::uint32_t>(std::popcount(lanes))) : pieces_;
}

stamp Engine::load(Hart& h, const void* p, std::uint32_t bytes, Due ready, bool vector) {
    charge_overhead(h, begin(h));
    Issued at = issue(h, 0, 1, ready);
    Data data;
    touch(h, address(p), bytes, false, at.first, data);
    finish_issue(h, at, data.granted);
    count(h, 1, vector);
    ++h.counters.loads;
    h.complete.later(Due(data.last, data.from));
    stamp r;
    r.first = r.last = data.last;
    r.cause = static_cast<std::uint8_t>(data.from);
    r.value = vector ? h.registers.make() : 0;
    return r;
}

stamp Engine::load_vector(Hart& h, const void* p, std::uint64_t lanes, Due ready) {
    charge_overhead(h, begin(h));
    Issued at = issue(h, 0, pieces_, ready);
    stamp r;
    Data data = lanes == 0 ? Data{} : touch_lanes(h, address(p), lanes, false, at.first);
    if (lanes == 0)
        data.first = data.last = at.last + wide(config_.l1.latency);
    finish_issue(h, at, data.granted);
    count(h, pieces_, true);
    ++h.counters.loads;
    h.complete.later(Due(data.last, data.from));
    r.first = data.first;
    r.last = data.last;
    r.cause = static_cast<std::uint8_t>(data.from);
    r.value = h.registers.make();
    return r;
}

stamp Engine::gather(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready) {
    charge_overhead(h, begin(h));
    std::uint32_t instructions = indexed_instructions(lanes);
    Issued at = issue(h, 0, instructions, ready);
    stamp r;
    Data data = lanes == 0 ? Data{} : touch_indexed(h, address(p), index, lanes, false, at.first);
    if (lanes == 0)
        data.first = data.last = at.last + wide(config_.l1.latency);
    finish_issue(h, at, data.granted);
    count(h, instructions, true);
    ++h.counters.loads;
    ++h.counters.gathers;
    h.complete.later(Due(data.last, data.from));
    r.first = data.first;
    r.last = data.last;
    r.cause = static_cast<std::uint8_t>(data.from);
    r.value = h.registers.make();
    return r;
}

inline void Engine::stored(Hart& h, const Data& data) {
    h.stored = std::max(h.stored, data.last);
    h.complete.later(Due(data.last, data.from));
}

void Engine::store(Hart& h, const void* p, std::uint32_t bytes, Due ready) {
    Issued at = issue(h, 0, 1, ready);
    Data data;
    touch(h, address(p), bytes, true, at.first, data);
    finish_issue(h, at, data.granted);
    count(h, 1, false);
    ++h.counters.stores;
    stored(h, data);
}

void Engine::store_vector(Hart& h, const void* p, std::uint64_t lanes, Due ready) {
    Issued at = issue(h, 0, pieces_, ready);
    Data data;
    if (lanes != 0)
        data = touch_lanes(h, address(p), lanes, true, at.first);
    finish_issue(h, at, data.granted);
    count(h, pieces_, true);
    ++h.counters.stores;
    stored(h, data);
}

void Engine::scatter(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready) {
    std::uint32_t instructions = indexed_instructions(lanes);
    Issued at = issue(h, 0, instructions, ready);
    Data data;
    if (lanes != 0)
        data = touch_indexed(h, address(p), index, lanes, true, at.first);
    finish_issue(h, at, data.granted);
    count(h, instructions, true);
    ++h.counters.stores;
    ++h.counters.scatters;
    stored(h, data);
}

void Engine::prefetch(Hart& h, const void* p, Due ready) {
    Issued at = issue(h, 0, 1, ready);
    cycle t = h.core->ports.take(at.first << port_shift_) >> port_shift_;
    ++h.core->l1.counters().busy_cycles;
    h.core->l1.prefetch(address(p) >> line_shift_, t, h.phase);
    finish_issue(h, at, 0);
    count(h, 1, false);
}

/// Whole lines only; an instruction each.
void Engine::discard(Hart& h, const void* p, std::uint32_t bytes, Due ready) {
    std::uint64_t begin = address(p);
    std::uint64_t end = begin + bytes;
    auto l2_line = wide(config_.l2.line_bytes);
    std::uint64_t first = (begin + line_bytes_ - 1) >> line_shift_;
    std::uint64_t last = end >> line_shift_;
    std::uint32_t lines = last > first ? static_cast<std::uint32_t>(last - first) : 0;
    Issued at = issue(h, 0, std::max(1U, lines), ready);
    for (std::uint64_t line = first; line < last; ++line) {
        h.core->l1.discard(line);
        std::uint64_t outer = (line << line_shift_) / l2_line * l2_line;
        if (outer >= begin && outer + l2_line <= end)
            l2_.discard(outer);
    }
    finish_issue(h, at, 0);
    count(h, 1, false);
}

// --- shared words
// -----------------------------------------------------------------------------------------------------

/// Shared words are not reordered: they act after everything that the thread let happen before, at their
/// issue, when no other thread is earlier. Only a load under a quantum does not wait for the others.
void Engine::before_atomic(Hart& h, isa::timing::atomic kind, Due ready) {
    ready.later(Due(h.now, Cause::synchronise));
    Issued at = issue(h, 0, 1, ready);
    h.now = at.last;
    if (scheduler_.exact() || kind != isa::timing::atomic::load_acquire) {
        Away away;
        scheduler_.wait_turn(Scheduler::key(at.last, h.number));
    }
    finish_issue(h, at, 0);
    count(h, 1, false);
    ++h.counters.atomics;
    h.acting = Due(at.last, Cause::synchronise);
}

/// What somebody else wrote shortly before `t` is read when it becomes visible, and so is what lies in the
/// future of a thread that a quantum let run behind.
void Engine::check_visible(Hart& h, std::uint64_t address, cycle t, Due& ready) {
    const Published::Write* w = published_.find(address);
    if (w == nullptr || w->writer == h.number)
        return;
    if (t < w->written)
        ++h.counters.causality_waits;
    ready.later(Due(w->visible, Cause::synchronise));
}

/// The word has been written: other copies of its line go, and those that wait for it wake.
void Engine::publish(Hart& h, std::uint64_t address, cycle written, cycle visible) {
    cycle oldest = written > ring_ ? written - ring_ : 0;
    published_.write({address, written, visible, h.number}, oldest);
    const auto* word = reinterpret_cast<const std::int32_t*>(base_ + address);
    auto woken = [&](Hart* sleeper) {
        if (sleeper->waits_for != word)
            return false;
        cycle wake = std::max(sleeper->acting.at(), visible);
        sleeper->acting = Due(wake, Cause::synchronise);
        scheduler_.wake(Scheduler::key(wake, sleeper->number));
        return true;
    };
    sleepers_.erase(std::remove_if(sleepers_.begin(), sleepers_.end(), woken), sleepers_.end());
}

stamp Engine::after_atomic(Hart& h, isa::timing::atomic kind, const void* p, bool wrote) {
    cycle t = h.acting.at();
    std::uint64_t a = address(p);
    std::uint64_t line = a >> line_shift_;
    auto l1_latency = wide(config_.l1.latency);
    auto visibility = wide(config_.coherence.visibility_cycles);
    Due ready;
    if (kind == isa::timing::atomic::load_acquire) {
        Data data;
        touch_line(h, line, false, 1, 1, t, data);
        ready = Due(data.last, data.from);
        check_visible(h, a, t, ready);
    } else {
        for (Core& core : cores_)
            core.l1.invalidate(line, t, h.phase);
        if (kind == isa::timing::atomic::store_release) {
            ++h.counters.releases;
            cycle done = std::max(t, h.stored);
            l2_.write(a, done + l1_latency, h.phase, false);
            ready = Due(done, Cause::synchronise);
            publish(h, a, t, done + visibility);
        } else {
            ++h.counters.modifications;
            Answer answer = l2_.modify(a, t + l1_latency, h.phase);
            ready = Due(answer.ready, answer.from);
            check_visible(h, a, t, ready);
            ready = Due(ready.at() + wide(config_.coherence.atomic_cycles), ready.why());
            if (wrote)
                publish(h, a, t, std::max(ready.at(), h.stored) + visibility);
        }
    }
    h.complete.later(ready);
    stamp r;
    r.first = r.last = ready.at();
    r.cause = static_cast<std::uint8_t>(ready.why());
    return r;
}

stamp Engine::wait_while(Hart& h, const std::int32_t* p, std::int32_t value, Due ready) {
    before_atomic(h, isa::timing::atomic::load_acquire, ready);
    const volatile std::int32_t* word = p;
    while (*word == value) {
        ++h.counters.waits;
        cycle since = h.acting.at();
        h.waits_for = p;
        sleepers_.push_back(&h);
        {
            Away away;
            scheduler_.sleep();
        }
        h.waits_for = nullptr;
        cycle woken = h.acting.at();
        if (woken > h.accounted) {
            h.account(h.accounted, woken, Cause::synchronise);
            h.accounted = woken;
        }
        h.counters.spins += (woken - since) / wide(config_.core.spin_period);
        h.bound.later(Due(woken, Cause::synchronise));
        h.now = std::max(h.now, woken);
    }
    return after_atomic(h, isa::timing::atomic::load_acquire, p, false);
}

// --- the rest
// ---------------------------------------------------------------------------------------------------------

void Engine::request_page(Hart& h, isa::page_service& service, std::int32_t space, std::int32_t kind,
                          std::int32_t index) {
    ++h.counters.pages;
    Away away;
    scheduler_.call([&service, space, kind, index] { service.make_page(space, kind, index); });
}

std::size_t Engine::set_phase(Hart& h, std::size_t phase) {
    if (phase >= phases_.size()) {
        fmt::print(stderr, "razor-sim: broken invariant: phase {} of {}\n", phase, phases_.size());
        std::abort();
    }
    return std::exchange(h.phase, phase);
}

Report Engine::report(int workers, const std::vector<std::string>& phases) const {
    Report r;
    r.config = config_;
    r.phases = phases;
    r.structures = attribution_.structures();
    r.workers = workers;
    r.traffic = attribution_.cells();
    r.l2 = l2_.counters();
    r.memory = memory_.counters();
    r.memory_by_rank = memory_.rank_counters();
    r.phase_vops.resize(phases.size());
    r.phase_instructions.resize(phases.size());
    for (const Hart& h : harts_) {
        r.cycles = std::max(r.cycles, h.accounted);
        for (const auto& row : core_counters)
            r.core.*row.count += h.counters.*row.count;
        for (std::size_t i = 0; i < phases.size(); ++i) {
            r.phase_vops[i] += h.phase_vops[i];
            r.phase_instructions[i] += h.phase_instructions[i];
        }
    }
    for (const Core& core : cores_)
        r.l1.push_back(const_cast<Core&>(core).l1.counters());
    for (const Hart& h : harts_) {
        auto threads = static_cast<int>(config_.chip.threads);
        int number = static_cast<int>(h.number);
        ThreadReport t{h.worker, number / threads, number % threads, h.accounted, h.stacks};
        t.stacks[h.phase][static_cast<std::size_t>(Cause::idle)] += r.cycles - h.accounted;
        r.threads.push_back(std::move(t));
    }
    r.drained = std::max(r.cycles, to_core_cycles(config_, static_cast<integer>(r.memory.last_clock)));
    return r;
}

} // namespace sim
