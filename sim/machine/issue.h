// How an operation gets its place in time: the engine's hottest paths, for compute.cpp, access.cpp,
// store_path.cpp and shared_words.cpp.
#pragma once

#include "sim/machine/engine.h"

namespace sim {

/// While caches are only warmed: instructions are counted, and take what the sampler says of their kind of
/// work.
inline Issued Engine::pass(Hart& h, std::size_t kind, std::uint32_t instructions) {
    h.at->instructions += instructions;
    h.by_kind[kind] += instructions;
    h.ahead -= static_cast<std::int64_t>(std::uint64_t{instructions} * h.pace);
    return {h.now, h.now};
}

/// ... and a line is accessed as ever, but for time.
[[gnu::always_inline]] inline void Engine::warm_line(Hart& h, std::uint64_t line, bool write,
                                                     std::uint32_t accesses, std::uint32_t slots) {
    Cache& l1 = h.core->l1;
    l1.counters().busy_cycles += slots;
    std::array<CacheArray::Place, 1> place; // NOLINT: filled where it is used
    if (!notes_sites_ && l1.find_present(line, place)) [[likely]]
        l1.use_present(line, place, write, accesses, h.column);
    else
        warm_other_line(h, line, write, accesses);
}

/// It goes on at its cycle `now`, in the window at hand.
inline void Engine::come_to(Hart& h) const {
    h.ahead =
        (static_cast<std::int64_t>(window_end_) - static_cast<std::int64_t>(h.now)) * h.core->passed_a_cycle;
}

/// Returns when the other threads have come as far as this one's cycle `t`.
inline cycle Engine::turn(Hart& h, cycle t) {
    if (warming_) [[unlikely]]
        return t;
    Scheduler::Key k = Scheduler::key(t, h.number);
    if (k > h.tile->scheduler.horizon()) {
        Away away(h);
        h.tile->scheduler.yield(k);
        come_back(h, t);
        if (warming_) [[unlikely]] { // since then
            h.now = std::max(h.now, t);
            come_to(h);
        }
    }
    h.now = std::max(h.now, t);
    return t;
}

/// The thread's cycles up to its last issue have a cause.
inline void Engine::account_issue(Hart& h, Issued at, std::uint32_t instructions, Due ready) const {
    const cycle least = issue_width_ == 1 ? instructions : (instructions + issue_width_ - 1) / issue_width_;
    const cycle begin = std::max(h.accounted, at.first), end = at.last + 1;
    const cycle stalled = std::min(std::max(ready.at(), h.accounted), begin);
    const cycle busy = begin + std::min(least, end - begin);
    if (end > h.boundary) [[unlikely]] {
        h.account(h.accounted, stalled, ready.why());
        h.account(stalled, begin, Cause::slots);
        h.account(begin, busy, Cause::busy);
        h.account(busy, end, Cause::slots);
    } else {
        Stack& stack = h.at->stack;
        stack[static_cast<std::size_t>(ready.why())] += stalled - h.accounted;
        stack[static_cast<std::size_t>(Cause::slots)] += begin - stalled + (end - busy);
        stack[static_cast<std::size_t>(Cause::busy)] += busy - begin;
    }
    h.accounted = end;
}

/// Returns the cycle from which the thread's operation looks for its issue slots, when the others have come
/// so far.
inline cycle Engine::come_to_issue(Hart& h, Due ready) {
    const cycle t = ready.at();
    if (in_order_) {
        turn(h, t);
        const cycle now = std::max(t, h.bound.at()); // it may have waited since its operands were looked at
        return hold_policy_ ? hold_core(h, now) : now;
    }
    const cycle acts = begin(h).at();
    turn(h, t > acts + booking_reach ? t - booking_reach : acts);
    return std::max(t, h.bound.at());
}

inline void Engine::note_issue(Hart& h, std::size_t kind, std::uint32_t instructions, Issued at, Due ready) {
    if (hold_policy_)
        h.core->busy_until = std::max(h.core->busy_until, at.last + 1);
    h.at->instructions += instructions;
    h.by_kind[kind] += instructions;
    if (at.last >= h.accounted)
        account_issue(h, at, instructions, ready);
}

[[gnu::always_inline]] inline Issued Engine::issue_here(Hart& h, std::size_t kind, std::uint32_t instructions,
                                                        Due ready) {
    if (warming_) [[unlikely]]
        return pass(h, kind, instructions);
    const cycle t = come_to_issue(h, ready);
    Issued at{};
    if (needs_[kind] == Needs::slot) {
        Calendar::Span s = h.core->issue.take(t << issue_shift_, instructions);
        at = {s.first >> issue_shift_, s.last >> issue_shift_};
    } else {
        at = book(*h.core, kind, instructions, t);
    }
    note_issue(h, kind, instructions, at, ready);
    return at;
}

/// ... of a single instruction.
[[gnu::always_inline]] inline Issued Engine::issue_here(Hart& h, std::size_t kind, Due ready) {
    if (warming_) [[unlikely]]
        return pass(h, kind, 1);
    const cycle t = come_to_issue(h, ready);
    cycle at;
    if (needs_[kind] == Needs::slot)
        at = h.core->issue.take(t << issue_shift_) >> issue_shift_;
    else
        at = book(*h.core, kind, 1, t).last;
    note_issue(h, kind, 1, {at, at}, ready);
    return {at, at};
}

/// By a call: where that is no more than a small part of what is done.
[[gnu::noinline]] inline Issued Engine::issue(Hart& h, std::size_t kind, std::uint32_t instructions,
                                              Due ready) {
    return issue_here(h, kind, instructions, ready);
}
[[gnu::noinline]] inline Issued Engine::issue(Hart& h, std::size_t kind, Due ready) {
    return issue_here(h, kind, ready);
}

/// More than a calendar takes at once.
[[gnu::always_inline]] inline Issued Engine::issue_all(Hart& h, std::size_t kind, std::uint32_t instructions,
                                                       Due ready) {
    constexpr std::uint32_t most = 64;
    Issued at = issue_here(h, kind, std::min(instructions, most), ready);
    while (instructions > most)
        [[unlikely]] {
            instructions -= most;
            at.last = issue(h, kind, std::min(instructions, most), ready).last;
        }
    return at;
}

/// Ends an operation: later ones count from it (rule 2). A miss that waited for an MSHR left the pipeline
/// only then.
inline void Engine::finish_issue(Hart& h, Issued at, cycle granted, Cause held) {
    if (warming_) [[unlikely]]
        return;
    h.bound.later(*h.oldest);
    if (granted > at.last)
        h.bound.later(Due(granted, held));
    *h.oldest = Due(at.last, Cause::busy);
    h.issued = std::max(h.issued, at.last);
    if (++h.oldest == h.window_end)
        h.oldest = h.window.data();
}

inline void Engine::count(Hart& h, std::uint32_t instructions, bool vector) {
    ++h.at->vops;
    if (vector) {
        ++h.counters.vector_vops;
        h.vector_instructions += instructions;
    }
}

inline void Engine::charge_overhead(Hart& h, std::uint32_t overhead, Due ready) {
    if (overhead != 0)
        charge(h, overhead, ready);
}

[[gnu::noinline]] inline void Engine::charge(Hart& h, std::uint32_t overhead, Due ready) {
    h.overhead += overhead;
    std::uint32_t whole = h.overhead / 1024;
    h.overhead %= 1024;
    if (whole == 0)
        return;
    h.counters.overhead_instructions += whole;
    if (whole == 1)
        issue(h, integer_kind, ready);
    else
        issue(h, integer_kind, whole, ready);
}

/// A line is to be accessed by the operation at hand: of which the first one, or a further one.
inline traces::Part Engine::meet_site(Hart& h) const {
    h.tile->site = h.site;
    if (h.site.number == SiteAtHand::none)
        return traces::Part::aside;
    if (!h.site.first)
        return traces::Part::access;
    if (strides_)
        h.tile->site.number = h.tile->load_sites.number_if_met(h.place);
    return traces::Part::operation;
}

/// It was accessed: a site has its number by the first access that took place, as in a trace.
inline void Engine::pass_site(Hart& h) const {
    if (strides_ && h.site.first && h.site.number != SiteAtHand::none)
        h.site.number = h.tile->load_sites.number(h.place);
    h.site.first = false;
}

/// What most accesses are, at once: hits, through ports that are free soon. Of each of so many adjacent lines
/// `accesses`, which take `slots` of the ports. False where anything else is to be done or noted: then
/// nothing has happened.
template <std::uint32_t lines>
[[gnu::always_inline]] inline bool Engine::touch_present(Hart& h, std::uint64_t line, bool write,
                                                         std::uint32_t accesses, std::uint32_t slots,
                                                         cycle from, Data& data) const {
    Core& core = *h.core;
    std::array<CacheArray::Place, lines> places; // NOLINT: filled where it is used
    if (notes_accesses_ || !core.l1.find_present(line, places))
        return false;
    Calendar::Span s; // NOLINT: likewise
    if (!core.ports.take_near(from << port_shift_, lines * slots, (from + port_backlog) << port_shift_, s))
        return false;
    core.l1.counters().busy_cycles += lines * slots;
    core.l1.use_present(line, places, write, accesses, h.column);
    data.first = std::min(data.first, (s.first >> port_shift_) + l1_latency_);
    const cycle last = (s.last >> port_shift_) + l1_latency_;
    if (last > data.last || (last == data.last && Cause::l1 > data.from)) {
        data.last = last;
        data.from = Cause::l1;
    }
    return true;
}

/// `accesses` of a line, of so many bytes in all from the address on.
inline void Engine::touch_line(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write,
                               std::uint32_t accesses, std::uint32_t slots, cycle& from, Data& data) {
    Core& core = *h.core;
    const std::uint64_t line = address >> line_shift_;
    if (warming_) [[unlikely]]
        return warm_line(h, line, write, accesses, slots);
    Calendar::Span s = core.ports.take(from << port_shift_, slots);
    core.l1.counters().busy_cycles += slots;
    cycle at = s.first >> port_shift_;
    if (at > from + port_backlog) [[unlikely]]
        data.granted = std::max(data.granted, at - port_backlog);
    traces::Part part = traces::Part::aside;
    if (notes_sites_) [[unlikely]]
        part = meet_site(h);
    if (recorder_ != nullptr) [[unlikely]]
        h.tile->tap->site = h.trace_site;
    Answer a = core.l1.access(line, write, accesses, at, h.column);
    while (a.refused)
        [[unlikely]] {
            if (a.moved)
                note_refused(h, address, bytes, write ? Passing::write : Passing::read, at, part);
            from = at = await_room(h, at, a.ready);
            data.granted = std::max(data.granted, at);
            if (notes_sites_) // others have had theirs meanwhile
                meet_site(h);
            if (recorder_ != nullptr)
                h.tile->tap->site = h.trace_site;
            a = core.l1.access(line, write, accesses, at, h.column);
        }
    if (notes_sites_) [[unlikely]]
        pass_site(h);
    if (recorder_ != nullptr) [[unlikely]]
        note_touch(h, address, bytes, write, accesses, at, part);
    cycle last = (s.last >> port_shift_) + l1_latency_; // through the ports
    if (is_ticket(a.ready)) {
        data.tickets[data.open++] = a.ready;
        if (last <= h.tile->tickets.floors().any)
            return;
    } else {
        last = std::max(a.ready, last);
        data.first = std::min(data.first, a.ready);
    }
    if (last > data.last || (last == data.last && a.from > data.from)) {
        data.last = last;
        data.from = a.from;
    }
}

/// What a load brings.
inline stamp Engine::loaded(Hart& h, const Data& data, bool vector, bool broadcast) {
    stamp r;
    if (warming_) [[unlikely]] {
        r.value = vector ? make_value(h, broadcast) : 0;
        return r;
    }
    if (data.open != 0) [[unlikely]] {
        r = loaded_ticket(h, data);
    } else {
        r.first = data.first;
        r.last = data.last;
        r.cause = static_cast<std::uint8_t>(data.from);
        h.complete.later(Due(data.last, data.from));
    }
    r.value = vector ? make_value(h, broadcast) : 0;
    return r;
}

} // namespace sim
