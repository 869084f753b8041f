// What a controller does next: the part of dram_controller.h that chooses.
#include "sim/memory/dram_controller.h"

#include <algorithm>

namespace sim {

/// `only_oldest`: not for a younger burst.
DramController::Wish DramController::wish(const Bank& b, Index number, std::size_t k,
                                          bool only_oldest) const {
    Index oldest = b.oldest[k], hit = b.hit[k], own = set(b), sets = ranks_ * groups_;
    Wish w;
    w.bank = number;
    Clock after; // that a refresh may come
    if (b.open && hit != none && (!only_oldest || hit == oldest)) {
        w.urgency = entries_[hit].number;
        w.from = b.column_from;
        w.shared = shared_column(static_cast<Column>(k)) * sets + own;
        after = t_.precharge[k] + t_.tRP;
    } else if (b.open) {
        w.urgency = entries_[oldest].number | row_command;
        w.from = b.precharge_from;
        w.shared = shared_precharge * sets + own;
        after = t_.tRP;
    } else {
        w.urgency = entries_[oldest].number | row_command;
        w.from = b.activate_from;
        w.shared = shared_activate * sets + own;
        after = std::max(t_.tRC, t_.tRCD + t_.precharge[k] + t_.tRP);
    }
    w.until = b.refresh == never ? never : b.refresh - std::min(b.refresh, after);
    if (per_bank_ && !b.open && b.refresh != never) { // or waits for the refresh of another bank
        Clock other = ranks_state_[b.rank].refresh;
        w.until = std::min(w.until, other - std::min(other, t_.activate[at(Near::group)]));
    }
    return w;
}

/// Takes a wish for the next step if it comes before it and does not hold up what is urgent.
void DramController::consider(const Wish& w, Clock from, const Step* urgent) {
    Clock t = std::max(w.from, allowed(w, with_buses(from)));
    if (t > w.until || t > step_.at || (t == step_.at && w.urgency >= step_.urgency))
        return;
    Step s;
    s.at = t;
    s.urgency = w.urgency;
    s.of = w.bank;
    s.kind = w.urgency < row_command                          ? Step::column
             : w.shared < shared_precharge * ranks_ * groups_ ? Step::activate
                                                              : Step::precharge;
    if (urgent == nullptr || !delays(s, *urgent))
        step_ = s;
}

/// Whether the urgent command would have to wait for `s`.
bool DramController::delays(const Step& s, const Step& urgent) const {
    const Bank &a = banks_[s.of], &b = banks_[urgent.of];
    bool column = s.kind == Step::column, urgent_column = urgent.kind == Step::column;
    if (column && urgent_column) {
        std::size_t k = at(direction());
        Near near = a.rank != b.rank ? Near::channel : a.group != b.group ? Near::rank : Near::group;
        return s.at + t_.column[k][k][at(near)] > urgent.at;
    }
    if (s.kind == Step::activate && urgent.kind == Step::activate && a.rank == b.rank)
        return true;
    return s.at == urgent.at && (column_bus_ == 0 || column == urgent_column);
}

void DramController::make_plan() {
    planned_ = true;
    const Queue& q = queue_[at(direction())];
    Clock from = now_;
    for (bool again = true; again;) {
        again = false;
        step_ = {};
        // From the clock at which the oldest burst has waited too long it goes before others.
        Clock end = patience(q);
        if (q.size == 0 || end <= from) {
            plan_unasked(from);
            if (q.size != 0)
                plan_urgent(q, from);
            return;
        }
        Clock best = never;
        std::uint64_t urgency = never;
        std::size_t chosen = 0;
        const std::array<Clock, 2> bus_from = with_buses(from);
        for (std::size_t i = 0; i < q.banks.size(); ++i) { // without branches: none of these is foreseeable
            const Wish& w = q.banks[i];
            Clock t = std::max(w.from, allowed(w, bus_from));
            t = t > w.until ? never : t;
            const auto better =
                static_cast<std::uint64_t>((t < best) | ((t == best) & (w.urgency < urgency)));
            best ^= (best ^ t) & -better;
            urgency ^= (urgency ^ w.urgency) & -better;
            chosen ^= (chosen ^ i) & -better;
        }
        if (timeout_page_ || best >= refreshes_from_)
            plan_unasked(from);
        consider(q.banks[chosen], from, nullptr);
        if (step_.at > end) {
            from = end;
            again = true;
        }
    }
}

void DramController::plan_urgent(const Queue& q, Clock from) {
    Index number = entries_[q.oldest].bank;
    Step others = step_; // refreshes
    step_ = {};
    consider(wish(banks_[number], number, at(direction()), true), from, nullptr);
    Step urgent = step_;
    if (others.before(step_))
        step_ = others;
    for (const Wish& w : q.banks)
        if (urgent.at == never)
            consider(w, from, nullptr);
        else if (w.bank != number)
            consider(w, from, &urgent);
}

/// What no request asks for.
void DramController::plan_unasked(Clock from) {
    plan_refreshes(from);
    if (timeout_page_)
        plan_idle_banks(from);
}

void DramController::plan_refreshes(Clock from) {
    if (t_.tREFI == 0)
        return;
    for (Index rank = 0; rank < ranks_; ++rank) {
        const Rank& r = ranks_state_[rank];
        Step s;
        s.of = rank;
        s.urgency = 0;
        bool open =
            per_bank_ ? banks_[rank * banks_per_rank_ + r.refreshes % banks_per_rank_].open : r.open != 0;
        Clock before = r.refresh - t_.around_refresh();
        if (postponable_ != 0 && !r.postponed && r.refresh == r.due && before >= from && busy(r, before)) {
            s.kind = Step::decide;
            s.at = before;
        } else if (Clock idle = std::max(from, r.used + t_.around_refresh());
                   r.postponed && r.queued == 0 && made_up(r, idle) < r.refresh) {
            s.kind = Step::decide;
            s.at = idle;
        } else if (open) {
            s.kind = Step::close_for_refresh;
            s.at = std::max(r.refresh - t_.tRP, bus_from_[0]);
        } else {
            s.kind = Step::refresh;
            s.at = std::max({r.refresh, r.closed_from, bus_from_[0]});
        }
        if (s.before(step_))
            step_ = s;
    }
}

/// Rows that nobody has wanted for some time.
void DramController::plan_idle_banks(Clock from) {
    for (Index number = 0; number < banks_.size(); ++number) {
        const Bank& b = banks_[number];
        if (!b.open || b.hit[0] != none || b.hit[1] != none)
            continue;
        Step s;
        s.kind = Step::close_idle;
        s.of = number;
        s.urgency = idle_row;
        s.at = std::max({from, b.precharge_from, b.used + page_timeout_, bus_from_[0]});
        if ((b.refresh == never || s.at + t_.tRP <= b.refresh) && s.before(step_))
            step_ = s;
    }
}

} // namespace sim
