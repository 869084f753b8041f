// Computation and branches: the timing port's functions (isa/simulated/port.h) gather when operands are
// there.
#include "sim/machine/issue.h"

namespace sim {

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

/// Instructions that need more than an issue slot each: takes what they need from `t` on.
Issued Engine::book(Core& core, std::size_t kind, std::uint32_t instructions, cycle t) const {
    if (needs_[kind] == Needs::several)
        return book_together(core, kind, instructions, t);
    Issued at{};
    std::uint32_t interval = interval_[kind];
    for (std::uint32_t i = 0; i < instructions; ++i) {
        cycle begin = core.units[class_of(kind)]->take_run(t, interval);
        at.last = core.issue.take(begin << issue_shift_) >> issue_shift_;
        t = begin + interval;
        at.first = i == 0 ? at.last : at.first;
    }
    return at;
}

/// Each in the first cycle, from `t` and from that of the one before on, at which an issue slot, a port and a
/// unit are free. Ports and unit are looked at for 64 cycles together.
Issued Engine::book_together(Core& core, std::size_t kind, std::uint32_t instructions, cycle t) const {
    const std::uint32_t interval = interval_[kind];
    std::optional<Calendar>& own = core.units[class_of(kind)];
    Calendar* unit = shared_[kind] ? &core.shared->calendar : own ? &*own : nullptr;
    const std::vector<std::uint8_t>& ports = pairing_.of(kind);
    std::array<std::uint64_t, Pairing::most_ports> open; // when each of them is free
    Issued at{};
    for (std::uint32_t left = instructions;;) {
        const cycle block = t - t % 64;
        for (std::size_t i = 0; i < ports.size(); ++i)
            open[i] = core.issue_ports[ports[i]].free_around(t);
        const auto free_from = [&](cycle from) {
            if (from >= block + 64)
                return std::uint64_t{0};
            std::uint64_t any = ports.empty() ? ~std::uint64_t{0} : 0;
            for (std::size_t i = 0; i < ports.size(); ++i)
                any |= open[i];
            return any & (unit != nullptr ? unit->free_around(from) : ~std::uint64_t{0} << from % 64);
        };
        for (std::uint64_t free = free_from(t); free != 0;) {
            const cycle allowed = block + static_cast<cycle>(std::countr_zero(free));
            const Calendar::Slot slot = core.issue.find(allowed << issue_shift_);
            t = slot >> issue_shift_;
            if (t == allowed && unit != nullptr)
                t = unit->find_run(t, interval);
            if (t != allowed) {
                free = t < block + 64 ? free & ~std::uint64_t{0} << t % 64 : 0;
                continue;
            }
            core.issue.mark(slot);
            if (!ports.empty()) {
                std::size_t i = 0;
                while ((open[i] >> t % 64 & 1) == 0)
                    ++i;
                open[i] ^= std::uint64_t{1} << t % 64;
                core.issue_ports[ports[i]].mark(t);
                ++core.port_instructions[ports[i]];
            }
            if (unit != nullptr)
                unit->mark_run(t, interval);
            if (shared_[kind])
                core.shared->busy_cycles += interval;
            at.first = left == instructions ? t : at.first;
            at.last = t;
            if (--left == 0)
                return at;
            free = free_from(t);
        }
        t = std::max(t, block + 64);
    }
}

/// A shuffle whose result is a scalar takes one lane out: no instruction set lacks that.
constexpr std::size_t extract_kind = vector_kind(static_cast<std::size_t>(operation::shuffle));

[[gnu::always_inline]] inline stamp Engine::compute(Hart& h, std::size_t kind, std::uint32_t instructions,
                                                    Due ready, bool vector) {
    settle(h, ready);
    h.memory_operands = 0;
    const bool broadcast = kind == vector_kind(static_cast<std::size_t>(operation::broadcast));
    if (broadcast)
        instructions = 1; // all registers of the value are the same one
    const bool one_lane = !vector && kind == extract_kind;
    const std::uint32_t taken = one_lane ? instructions : instructions * takes_[kind];
    if (vector_moves_ != 0) [[unlikely]]
        charge(h, vector_moves_ * taken, begin(h));
    Issued at = issue_all(h, kind, taken, ready);
    finish_issue(h, at, 0);
    count(h, instructions, vector || instructions > 1);
    std::uint32_t latency = latency_[kind];
    stamp r;
    r.last = at.last + latency;
    r.first = vector ? at.first + latency : r.last;
    r.cause = static_cast<std::uint8_t>(Cause::compute);
    r.value = vector ? make_value(h, broadcast) : 0;
    h.complete.later(Due(r.last, Cause::compute));
    return r;
}

/// Among scalars.
[[gnu::always_inline]] inline stamp Engine::compute_scalar(Hart& h, std::size_t kind, Due ready) {
    settle(h, ready);
    if (scalar_moves_ != 0) [[unlikely]]
        charge(h, scalar_moves_, begin(h));
    const Issued at = issue_here(h, kind, ready);
    finish_issue(h, at, 0);
    count(h, 1, false);
    stamp r;
    r.first = r.last = at.last + latency_[kind];
    r.cause = static_cast<std::uint8_t>(Cause::compute);
    h.complete.later(Due(r.last, Cause::compute));
    return r;
}

/// An address whose operands are there at `ready`, or when what is pending is: no instruction yet.
stamp Engine::fold_address(Hart& h, Due ready) {
    stamp s;
    s.first = ready.at();
    s.cause = static_cast<std::uint8_t>(ready.why());
    if (h.pending_count != 0) {
        std::array<cycle, 2> open{};
        for (std::size_t i = 0; i < h.pending_count; ++i)
            open[i] = h.pending[i].ticket;
        s.first = h.tile->tickets.join({ready.at(), ready.at(), ready.why()}, open.data(),
                                       static_cast<std::uint32_t>(h.pending_count));
        h.pending_count = 0;
    }
    s.last = fold_bits | ++h.last_address;
    ++h.counters.folded;
    count(h, 0, false);
    return s;
}

/// Something other than a load or store uses the address: now it is an instruction, once.
Due Engine::unfold(Hart& h, Due ready, const stamp& s) {
    auto number = static_cast<std::uint32_t>(s.last & ~fold_bits);
    Hart::Unfolded& u = h.unfolded[number % h.unfolded.size()];
    if (u.number != number) {
        Due operands = begin(h);
        if (is_ticket(s.first)) {
            Answered a = await(h, s.first);
            operands.later(Due(a.last, a.from));
        } else {
            operands.later(Due(s.first, static_cast<Cause>(s.cause)));
        }
        constexpr auto kind = static_cast<std::size_t>(operation::address);
        Issued at = issue(h, kind, operands);
        u = {number, at.last + latency_[kind]};
        ++h.counters.unfolded;
        h.complete.later(Due(u.ready, Cause::compute));
    }
    ready.later(Due(u.ready, Cause::compute));
    return ready;
}

void Engine::branch(Hart& h, site where, Due ready, bool taken) {
    end_stretch(h);
    if (prediction_ == Prediction::counters)
        h.tile->sites.bring(where);
    charge_overhead(h, overhead_, begin(h));
    settle(h, ready);
    Issued at = issue_here(h, branch_class, ready);
    finish_issue(h, at, 0);
    count(h, 1, false);
    ++h.counters.branches;
    cycle known = at.last + latency_[branch_class];
    h.complete.later(Due(known, Cause::compute));
    if (prediction_ == Prediction::perfect)
        return;
    if (prediction_ == Prediction::none) {
        h.bound.later(Due(known, Cause::branch));
    } else if (prediction_ == Prediction::counters
                   ? !h.core->predictor.right(h.tile->sites.number(where), h.history, taken)
                   : taken != (prediction_ == Prediction::taken)) {
        ++h.counters.mispredicts;
        h.bound.later(Due(known + wide(config_.core.mispredict_cycles), Cause::branch));
    }
}

} // namespace sim

namespace isa::timing {
namespace {

using sim::Engine;
using sim::Hart;

/// Lane by lane; across lanes to a vector; across lanes to a scalar.
enum class Shape { lanes, across, to_scalar };

/// An operation of the running thread on vectors, once `need` has been asked of every operand.
template <Shape shape, class... Stamp>
inline stamp operate_on(Engine& engine, Hart& hart, operation op, const Stamp&... operands) {
    const std::size_t kind = sim::vector_kind(static_cast<std::size_t>(op));
    if (shape == Shape::across)
        engine.end_stretch(hart);
    if (engine.warming()) [[unlikely]]
        return engine.warm_operation(hart, kind, shape != Shape::to_scalar, operands.value...);
    sim::Due ready = engine.begin(hart);
    const bool there = engine.in_registers(hart, operands...);
    if (!there)
        engine.allow_memory_operands(hart);
    const auto need = [&](const stamp& s) {
        if (shape == Shape::lanes)
            engine.need_lanes(hart, ready, s, engine.span(kind), there);
        else
            engine.need_last(hart, ready, s, engine.span(kind), there);
    };
    (need(operands), ...);
    return engine.compute(hart, kind, engine.vector_instructions(), ready, shape != Shape::to_scalar);
}
template <Shape shape, class... Stamp> inline stamp operate(operation op, const Stamp&... operands) {
    return operate_on<shape>(*sim::running_engine, *sim::running_hart, op, operands...);
}
template <class... Stamp> inline stamp operate_scalar(operation op, const Stamp&... operands) {
    Engine& engine = *sim::running_engine;
    Hart& hart = *sim::running_hart;
    if (engine.warming()) [[unlikely]]
        return engine.warm_scalar(hart, static_cast<std::size_t>(op));
    sim::Due ready = engine.begin(hart);
    (engine.need_scalar(hart, ready, operands), ...);
    return engine.compute_scalar(hart, static_cast<std::size_t>(op), ready);
}

} // namespace

stamp vector_op(operation op, const stamp& a) {
    return operate<Shape::lanes>(op, a);
}
stamp vector_op(operation op, const stamp& a, const stamp& b) {
    return operate<Shape::lanes>(op, a, b);
}
stamp vector_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    return operate<Shape::lanes>(op, a, b, c);
}
stamp cross_op(operation op, const stamp& a, const stamp& b) {
    Engine& engine = *sim::running_engine;
    Hart& hart = *sim::running_hart;
    if (op == operation::shuffle && engine.shuffles_by_lane()) [[unlikely]]
        engine.assemble_shuffle(hart, engine.begin(hart));
    return operate_on<Shape::across>(engine, hart, op, a, b);
}
stamp cross_to_scalar(operation op, const stamp& a, const stamp& b) {
    return operate<Shape::to_scalar>(op, a, b);
}
stamp scalar_op(operation op, const stamp& a) {
    return operate_scalar(op, a);
}
stamp scalar_op(operation op, const stamp& a, const stamp& b) {
    if (op == operation::address && sim::running_engine->folds_addresses()) [[unlikely]] {
        Engine& engine = *sim::running_engine;
        Hart& hart = *sim::running_hart;
        sim::Due ready;
        engine.need_scalar(hart, ready, a);
        engine.need_scalar(hart, ready, b);
        return engine.fold_address(hart, ready);
    }
    return operate_scalar(op, a, b);
}
stamp scalar_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    return operate_scalar(op, a, b, c);
}
void branch(site where, const stamp& condition, bool taken) {
    Engine& engine = *sim::running_engine;
    Hart& hart = *sim::running_hart;
    if (engine.warming()) [[unlikely]]
        return engine.warm_branch(hart, where, taken);
    sim::Due ready = engine.begin(hart);
    engine.need_scalar(hart, ready, condition);
    engine.branch(hart, where, ready, taken);
}

} // namespace isa::timing
