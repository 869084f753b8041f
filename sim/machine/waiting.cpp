// Waiting for what is not answered yet: tickets, room in L1s, operands, stores.
#include "sim/machine/issue.h"

namespace sim {

/// Returns when the ticket is answered.
Answered Engine::await(Hart& h, cycle ticket) {
    Answered a;
    while (!h.tile->tickets.find(ticket, a)) {
        h.tile->parked.push_back({&h, ticket});
        Away away(h);
        h.tile->scheduler.park();
    }
    return a;
}

/// For an access at cycle `since` that the L1 had no room for: returns the cycle, and when it has come, at
/// which to try again.
cycle Engine::await_room(Hart& h, cycle since, cycle until) {
    if (until != Answer::unknown && !maybe_sooner(until))
        return turn(h, until);
    if (until != Answer::unknown && latest(until) > h.tile->events->now())
        h.tile->events->look_again(latest(until));
    h.tile->parked.push_back({&h, 0});
    Away away(h);
    h.tile->scheduler.park();
    return std::max(since, h.bound.at());
}

Due Engine::await_operands(Hart& h, Due ready) {
    for (std::size_t i = 0; i < h.pending_count; ++i) {
        Hart::Pending p = h.pending[i];
        Answered a = await(h, p.ticket);
        ready.later(
            Due(p.span != 0 ? follow(a.first, a.last, p.span) : a.last, p.spill ? Cause::spill : a.from));
    }
    h.pending_count = 0;
    return ready;
}

/// Returns when it is known when all stores so far are in the L1.
void Engine::await_stores(Hart& h) {
    for (std::size_t i = 0; i < h.storing.size(); ++i)
        h.stored = std::max(h.stored, await(h, h.storing[i]).last);
    h.storing.clear();
    h.complete.later(Due(h.stored, Cause::memory));
}

/// Forgets tickets of stores that are answered, all others stay.
void Engine::settle_stores(Hart& h) {
    std::erase_if(h.storing, [&](cycle ticket) {
        Answered a;
        const bool known = h.tile->tickets.find(ticket, a);
        if (known)
            h.stored = std::max(h.stored, a.last);
        return known;
    });
}

/// Likewise of loads.
void Engine::settle_loads(Hart& h) {
    std::erase_if(h.loading, [&](cycle ticket) {
        Answered a;
        bool known = h.tile->tickets.find(ticket, a);
        if (known)
            h.complete.later(Due(a.last, a.from));
        return known;
    });
}

} // namespace sim
