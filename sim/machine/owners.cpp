// Whom work is for: threads are charged whenever that, or the phase or kind of their work, changes. A trace
// alone asks no more than who the first active lane works for.
#include "sim/machine/engine.h"

#include <bit>

namespace sim {

ThreadCost Hart::cost_of_column() const {
    ThreadCost c;
    for (std::size_t i = 0; i < cause_count; ++i) {
        c.cycles += at->stack[i];
        c.stalled += is_of_memory(static_cast<Cause>(i)) ? at->stack[i] : 0;
    }
    c.waiting = at->stack[static_cast<std::size_t>(Cause::synchronise)];
    c.instructions = at->instructions;
    return c;
}

/// With what its column has had since.
void Engine::charge_owners(Hart& h) const {
    const ThreadCost now = h.cost_of_column();
    options_.owners->count(h.tile->number, h.column,
                           {now.cycles - h.charged.cycles, now.stalled - h.charged.stalled,
                            now.waiting - h.charged.waiting, now.instructions - h.charged.instructions});
    h.charged = now;
}

void Engine::enter_for(Hart& h, std::size_t column, std::size_t party) const {
    if (options_.owners != nullptr)
        charge_owners(h);
    h.enter(column);
    h.column |= party;
    h.party = party;
    if (options_.owners != nullptr)
        h.charged = h.cost_of_column();
}

std::size_t Engine::set_owners(Hart& h, const std::int32_t* owner, std::uint64_t lanes) {
    const std::size_t before = h.party;
    if (options_.owners != nullptr)
        enter_for(h, plain_column(h.column), options_.owners->party(h.tile->number, owner, lanes));
    else if (recorder_ != nullptr)
        enter_for(h, plain_column(h.column),
                  lanes == 0 ? 0 : column_of_owner(owner[std::countr_zero(lanes)]));
    return before;
}

std::size_t Engine::narrow_owners(Hart& h, std::uint64_t lanes) {
    const std::size_t before = h.party;
    if (options_.owners != nullptr)
        enter_for(h, plain_column(h.column), options_.owners->narrowed(before, lanes));
    return before;
}

void Engine::restore_owners(Hart& h, std::size_t before) {
    if (options_.owners != nullptr || recorder_ != nullptr)
        enter_for(h, plain_column(h.column), before);
}

/// What counts begins, no thread working for anybody.
void Engine::begin_owners() {
    if (options_.owners == nullptr)
        return;
    options_.owners->forget();
    for (Hart& h : harts_)
        h.charged = h.cost_of_column();
}

void Engine::finish_owners(Report& r) {
    if (options_.owners == nullptr)
        return;
    for (Hart& h : harts_)
        charge_owners(h);
    for (const OwnerFigure& figure : owner_figures(config_.cache_levels()))
        r.owners.push_back(options_.owners->sum(figure));
}

} // namespace sim
