#include "sim/memory/dram_controller.h"

#include <algorithm>

namespace sim {

DramController::DramController(std::uint32_t number, const MemoryConfig& c, const DramTiming& timing)
    : t_(timing), number_(number), ranks_(static_cast<std::uint32_t>(c.ranks)),
      groups_(static_cast<std::uint32_t>(c.bank_groups)),
      banks_per_rank_(static_cast<std::uint32_t>(c.bank_groups * c.banks)),
      column_bus_(c.command_buses == 1 ? 0 : 1), first_ready_(c.scheduler == "fr-fcfs"),
      closed_page_(c.page_policy == "closed"), timeout_page_(c.page_policy == "timeout"),
      per_bank_(c.refresh == "per-bank"), high_(static_cast<std::size_t>(c.write_high)),
      low_(static_cast<std::size_t>(c.write_low)), age_cap_(static_cast<Clock>(c.age_cap)),
      page_timeout_(static_cast<Clock>(c.page_timeout)),
      postponable_(static_cast<Clock>(c.refresh_postponed * c.tREFI)),
      entries_(static_cast<std::size_t>(c.read_queue + c.write_queue)), banks_(ranks_ * banks_per_rank_),
      ranks_state_(ranks_), shared_(shared_kinds * ranks_ * groups_), counters_(ranks_) {
    queue_[0].capacity = static_cast<std::size_t>(c.read_queue);
    queue_[1].capacity = static_cast<std::size_t>(c.write_queue);
    for (Index i = 0; i < entries_.size(); ++i)
        entries_[i].next = i + 1 < entries_.size() ? i + 1 : none;
    free_ = 0;
    for (Index i = 0; i < banks_.size(); ++i) {
        Bank& b = banks_[i];
        b.rank = i / banks_per_rank_;
        b.group = i % banks_per_rank_ / static_cast<Index>(c.banks);
        b.bank = i % static_cast<Index>(c.banks);
    }
    if (t_.tREFI == 0)
        return;
    for (Index rank = 0; rank < ranks_; ++rank)
        schedule_refresh(ranks_state_[rank], rank);
}

void DramController::log(DramCommand::Kind kind, Clock at, const Bank& b, std::uint64_t row, bool automatic) {
    if (log_ != nullptr) [[unlikely]]
        log_->push_back({kind, at, number_, b.rank, b.group, b.bank, row, automatic});
}

// ---- queues

bool DramController::enqueue(Column kind, const DramPlace& p, std::uint64_t burst, std::uint64_t id,
                             Clock t) {
    advance_to(t);
    Index number = (p.rank * groups_ + p.group) * (banks_per_rank_ / groups_) + p.bank;
    Bank& b = banks_[number];
    MemoryCounters& n = counters_[p.rank];
    for (Index i = b.oldest[1]; i != none; i = entries_[i].bank_next)
        if (entries_[i].burst == burst) {
            if (kind == Column::read) {
                ++n.forwarded;
                done_.push_back({id, t});
            } else {
                ++n.merged;
            }
            return true;
        }
    std::size_t k = at(kind);
    Queue& q = queue_[k];
    if (q.size == q.capacity)
        return false;
    Index i = free_;
    Entry& e = entries_[i];
    free_ = e.next;
    e = {burst, id, p.row, arrivals_++, t, number, none, b.youngest[k], none, q.youngest, Row::hit};
    (q.youngest == none ? q.oldest : entries_[q.youngest].next) = i;
    q.youngest = i;
    ++q.size;
    if (b.youngest[k] == none) {
        b.oldest[k] = i;
        b.place[k] = static_cast<Index>(q.banks.size());
    } else {
        entries_[b.youngest[k]].bank_next = i;
    }
    b.youngest[k] = i;
    if (b.open && b.row == p.row && b.hit[k] == none)
        b.hit[k] = i;
    ++ranks_state_[p.rank].queued;
    if (b.oldest[k] == i)
        q.banks.emplace_back();
    renew(number);
    bool was_writing = writing_;
    choose_direction();
    // Usually the plan stays, or the burst's bank comes before it.
    if (timeout_page_ || postponable_ != 0 || writing_ != was_writing || q.size == 1 || step_.of == number ||
        patience(queue_[at(direction())]) <= step_.at)
        planned_ = false;
    else if (planned_ && k == at(direction()))
        consider(q.banks[b.place[k]], now_, nullptr);
    return true;
}

void DramController::remove(Index i, std::size_t k) {
    Entry& e = entries_[i];
    Bank& b = banks_[e.bank];
    Queue& q = queue_[k];
    (e.before == none ? q.oldest : entries_[e.before].next) = e.next;
    (e.next == none ? q.youngest : entries_[e.next].before) = e.before;
    (e.bank_before == none ? b.oldest[k] : entries_[e.bank_before].bank_next) = e.bank_next;
    (e.bank_next == none ? b.youngest[k] : entries_[e.bank_next].bank_before) = e.bank_before;
    if (b.oldest[k] == none) {
        q.banks[b.place[k]] = q.banks.back();
        banks_[q.banks.back().bank].place[k] = b.place[k];
        q.banks.pop_back();
    }
    --q.size;
    --ranks_state_[b.rank].queued;
    e.next = free_;
    free_ = i;
}

void DramController::flush() {
    flushing_ = queue_[1].size != 0;
    choose_direction();
    planned_ = false;
}

void DramController::choose_direction() {
    std::size_t reads = queue_[0].size, writes = queue_[1].size, least = flushing_ ? 0 : low_;
    flushing_ = flushing_ && writes != 0;
    if (writing_ && (writes <= least || (!draining_ && reads != 0)))
        writing_ = draining_ = false;
    if (!writing_ && (writes >= high_ || (reads == 0 && writes > least))) {
        writing_ = true;
        ++counters_[0].batches;
    }
    draining_ = writing_ && (draining_ || writes >= high_);
}

void DramController::find_hits(Bank& b) {
    for (std::size_t k = 0; k < 2; ++k) {
        b.hit[k] = none;
        if (b.open)
            for (Index i = b.oldest[k]; i != none && b.hit[k] == none; i = entries_[i].bank_next)
                if (entries_[i].row == b.row)
                    b.hit[k] = i;
    }
}

// ---- commands

void DramController::issue() {
    planned_ = false;
    now_ = step_.at;
    switch (step_.kind) {
    case Step::decide: {
        Rank& r = ranks_state_[step_.of];
        set_refresh(r, step_.of, r.postponed ? made_up(r, now_) : r.due + postponable_);
        r.postponed = true;
        return;
    }
    case Step::refresh:
        return refresh(step_.of);
    case Step::close_for_refresh: {
        bus_from_[0] = now_ + 1;
        ranks_state_[step_.of].closed_from = now_ + t_.tRP;
        Index first = step_.of * banks_per_rank_;
        if (per_bank_) {
            Bank& b = banks_[first + ranks_state_[step_.of].refreshes % banks_per_rank_];
            log(DramCommand::Kind::precharge, now_, b, b.row);
            ++counters_[b.rank].precharges;
            return close(b, now_);
        }
        DramCommand all{DramCommand::Kind::precharge_all, now_, number_, step_.of, 0, 0, 0};
        if (log_ != nullptr)
            log_->push_back(all);
        for (Index i = first; i < first + banks_per_rank_; ++i)
            if (banks_[i].open)
                close(banks_[i], now_);
        return;
    }
    case Step::column:
        return issue_column(banks_[step_.of]);
    case Step::activate:
        return issue_activate(banks_[step_.of]);
    case Step::precharge:
    case Step::close_idle: {
        Bank& b = banks_[step_.of];
        bus_from_[0] = now_ + 1;
        log(DramCommand::Kind::precharge, now_, b, b.row);
        ++counters_[b.rank].precharges;
        close(b, now_);
        b.conflict = step_.kind == Step::precharge;
        return;
    }
    }
}

void DramController::close(Bank& b, Clock at) {
    b.open = b.conflict = false;
    b.hit = {none, none};
    b.activate_from = std::max(b.activate_from, at + t_.tRP);
    --ranks_state_[b.rank].open;
    renew(number_of(b));
}

void DramController::issue_activate(Bank& b) {
    Entry& e = entries_[b.oldest[at(direction())]];
    Rank& r = ranks_state_[b.rank];
    MemoryCounters& n = counters_[b.rank];
    bus_from_[0] = now_ + 1;
    log(DramCommand::Kind::activate, now_, b, e.row);
    ++n.activates;
    if (e.found == Row::hit)
        e.found = b.conflict ? Row::conflict : Row::empty;
    else
        ++n.reopened;
    b.open = true;
    b.row = e.row;
    b.used = now_;
    b.column_from = now_ + t_.tRCD;
    b.precharge_from = now_ + t_.tRAS;
    b.activate_from = now_ + t_.tRC;
    find_hits(b);
    renew(number_of(b));
    ++r.open;
    r.activates[r.activated++ % 4] = now_;
    Clock four = r.activated < 4 ? 0 : r.activates[r.activated % 4] + t_.tFAW;
    for (Index g = 0; g < groups_; ++g) {
        Clock& from = shared_from(shared_activate)[b.rank * groups_ + g];
        from = std::max({from, four, now_ + t_.activate[at(g == b.group ? Near::group : Near::rank)]});
    }
}

void DramController::issue_column(Bank& b) {
    Column c = direction();
    std::size_t k = at(c);
    Index i = b.hit[k];
    const Entry e = entries_[i];
    MemoryCounters& n = counters_[b.rank];
    bus_from_[column_bus_] = now_ + 1;
    log(c == Column::read ? DramCommand::Kind::read : DramCommand::Kind::write, now_, b, e.row);
    Clock end = now_ + t_.data[k] + t_.burst;
    ++(e.found == Row::hit ? n.row_hits : e.found == Row::empty ? n.row_empties : n.row_conflicts);
    n.busy_clocks += t_.burst;
    n.last_clock = std::max(n.last_clock, end);
    if (c == Column::read) {
        Clock own = t_.data[0] + t_.burst + (e.found == Row::hit ? 0 : t_.tRCD) +
                    (e.found == Row::conflict ? t_.tRP : 0);
        ++n.read_bursts;
        n.read_clocks += end - e.arrival;
        n.queue_clocks += end - e.arrival - std::min(end - e.arrival, own);
        done_.push_back({e.id, end});
    } else {
        ++n.write_bursts;
    }
    counters_[0].turnarounds += any_ && last_write_ != writing_ ? 1 : 0;
    counters_[0].rank_switches += any_ && last_rank_ != b.rank ? 1 : 0;
    any_ = true;
    last_write_ = writing_;
    last_rank_ = b.rank;

    for (Column next : {Column::read, Column::write}) {
        Clock* from = shared_from(shared_column(next));
        const auto& owed = t_.column[k][at(next)];
        const Clock own = std::max(from[set(b)], now_ + owed[at(Near::group)]);
        for (Index rank = 0, s = 0; rank < ranks_; ++rank) {
            const Clock others = now_ + owed[at(rank == b.rank ? Near::rank : Near::channel)];
            for (Index g = 0; g < groups_; ++g, ++s)
                from[s] = std::max(from[s], others);
        }
        from[set(b)] = own;
    }
    b.precharge_from = std::max(b.precharge_from, now_ + t_.precharge[k]);
    b.used = now_;
    remove(i, k);
    b.hit[k] = e.bank_next;
    while (b.hit[k] != none && entries_[b.hit[k]].row != b.row)
        b.hit[k] = entries_[b.hit[k]].bank_next;
    if (closed_page_ && b.hit[0] == none && b.hit[1] == none) {
        log(DramCommand::Kind::precharge, b.precharge_from, b, b.row, true);
        ++n.precharges;
        close(b, b.precharge_from);
    } else {
        renew(number_of(b));
    }
    Rank& r = ranks_state_[b.rank];
    r.used = now_;
    choose_direction();
}

// ---- refreshes

/// When refresh `number` of a rank is due: ranks, and the banks of each, take turns.
Clock DramController::due(Index rank, std::uint64_t number) const {
    std::uint64_t turns = per_bank_ ? banks_per_rank_ : 1;
    return t_.tREFI + t_.tREFI * (number * ranks_ + rank) / (turns * ranks_);
}

void DramController::set_refresh(Rank& r, Index rank, Clock at) {
    r.refresh = at;
    Index first = rank * banks_per_rank_;
    if (per_bank_)
        for (Index i = 0; i < banks_per_rank_; ++i)
            banks_[first + (r.refreshes + i) % banks_per_rank_].refresh = due(rank, r.refreshes + i);
    else
        for (Index i = 0; i < banks_per_rank_; ++i)
            banks_[first + i].refresh = at;
    for (Index i = 0; i < banks_per_rank_; ++i)
        renew(first + i);
    // Where refreshes may be postponed, deciding that may come long before one.
    refreshes_from_ = postponable_ != 0 ? 0 : never;
    for (const Rank& other : ranks_state_)
        refreshes_from_ = std::min(refreshes_from_, other.refresh - std::min(other.refresh, t_.tRP));
}

/// The next one at its time, or, where that is past, at once if the rank has nothing to do.
void DramController::schedule_refresh(Rank& r, Index rank) {
    r.due = due(rank, r.refreshes);
    r.postponed = r.due < now_ + t_.tRFC && r.refreshes != 0 && postponable_ != 0;
    set_refresh(r, rank,
                !r.postponed    ? r.due
                : busy(r, now_) ? r.due + postponable_
                                : std::max(r.due, now_ + t_.tRFC));
}

void DramController::refresh(Index rank) {
    Rank& r = ranks_state_[rank];
    bus_from_[0] = now_ + 1;
    Index first = rank * banks_per_rank_;
    Bank& b = banks_[first + (per_bank_ ? r.refreshes % banks_per_rank_ : 0)];
    if (per_bank_)
        b.activate_from = std::max(b.activate_from, now_ + t_.tRFCpb);
    for (Index g = 0; g < groups_; ++g) {
        Clock& from = shared_from(shared_activate)[rank * groups_ + g];
        from = std::max(from, now_ + (per_bank_ ? t_.tRREFD : t_.tRFC));
    }
    log(per_bank_ ? DramCommand::Kind::refresh_bank : DramCommand::Kind::refresh, now_, b, 0);
    ++counters_[rank].refreshes;
    ++r.refreshes;
    r.refreshed = now_;
    schedule_refresh(r, rank);
}

} // namespace sim
