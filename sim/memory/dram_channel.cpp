#include "sim/memory/dram_channel.h"

#include <algorithm>
#include <utility>

namespace sim {

DramChannel::DramChannel(std::uint32_t number, const MemoryConfig& c, const DramTiming& timing,
                         std::uint64_t disorder)
    : t_(timing), slots_(c, timing, disorder), number_(number),
      groups_(static_cast<std::uint32_t>(c.bank_groups)),
      banks_per_group_(static_cast<std::uint32_t>(c.banks)), closed_page_(c.page_policy == "closed"),
      page_timeout_(c.page_policy == "timeout" ? static_cast<Clock>(c.page_timeout) : never),
      capacity_(static_cast<std::size_t>(c.write_queue)), high_(static_cast<std::size_t>(c.write_high)),
      low_(static_cast<std::size_t>(c.write_low)),
      banks_(static_cast<std::size_t>(c.ranks * c.bank_groups * c.banks)),
      counters_(static_cast<std::size_t>(c.ranks)) {
    queue_.reserve(capacity_);
}

void DramChannel::log(DramCommand::Kind kind, Clock at, const DramPlace& p, bool automatic) {
    if (log_ != nullptr) [[unlikely]]
        log_->push_back({kind, at, p.channel, p.rank, p.group, p.bank, p.row, automatic});
}

/// The clock for a column command while a row that is or will be closed is open; never: it comes too late.
Clock DramChannel::before_closing(const Bank& bank, const DramPlace& p, Column c, Clock now, Clock from) {
    for (const Opening* o : {&bank.before, &bank.now}) {
        if (o->row != p.row || o->close == never || from >= o->close)
            continue;
        Clock column = slots_.find_column(std::max(from, o->column_from), now, c, p.rank, p.group);
        if (column + t_.precharge[at(c)] <= o->close)
            return column;
    }
    return never;
}

/// Page policy "timeout": found out when the bank is wanted again.
void DramChannel::close_if_unused(Bank& bank, const DramPlace& p, Clock now) {
    if (bank.now.row == no_row || bank.now.close != never || now <= bank.used + page_timeout_)
        return;
    Clock t = std::max(bank.precharge_from, bank.used + page_timeout_);
    if (t > now)
        return;
    if (t + t_.tRP > bank.refresh) {
        bank.now.close = bank.refresh - t_.tRP;
        return;
    }
    DramPlace closed = p;
    closed.row = bank.now.row;
    log(DramCommand::Kind::precharge, t, closed, true);
    ++counters_[p.rank].precharges;
    bank.now.close = t;
}

/// Closes what is open; returns the clock from which the next row may be opened.
Clock DramChannel::close_row(Bank& bank, const DramPlace& p, Clock now, Row& row) {
    row = Row::empty;
    if (bank.now.row == no_row)
        return now;
    if (bank.now.close == never) {
        Clock t = slots_.find_precharge(std::max(now, bank.precharge_from), now, p.rank);
        if (t + t_.tRP > bank.refresh) {
            bank.now.close = bank.refresh - t_.tRP;
            return std::max(now, bank.refresh);
        }
        slots_.take_precharge(t);
        DramPlace closed = p;
        closed.row = bank.now.row;
        log(DramCommand::Kind::precharge, t, closed);
        ++counters_[p.rank].precharges;
        bank.now.close = t;
        row = Row::conflict;
    }
    return std::max({now, bank.now.close + t_.tRP, bank.activated + t_.tRC});
}

/// Has the row open and finds, but does not take, a clock for the column command, `from` or later. Other
/// commands are issued `now` or later.
DramChannel::Sent DramChannel::open_row(const DramPlace& p, Column c, Clock now, Clock from) {
    Bank& bank = bank_of(p);
    if (page_timeout_ != never)
        close_if_unused(bank, p, now);
    Clock after = t_.precharge[at(c)] + t_.tRP; // until a refresh may come
    if (Clock column = before_closing(bank, p, c, now, from); column != never)
        return {column, column, Row::hit, true};
    if (bank.now.row == p.row && bank.now.close == never) {
        Clock ready = std::max(now, bank.now.column_from);
        Clock column = slots_.find_column(std::max(from, ready), now, c, p.rank, p.group);
        if (column + after <= bank.refresh)
            return {ready, column, Row::hit, false};
        bank.now.close = bank.refresh - t_.tRP;
    }
    Sent s{};
    Clock opened = close_row(bank, p, now, s.row);
    for (;;) {
        opened = slots_.find_activate(opened, now, p.rank, p.group);
        bank.refresh = slots_.next_refresh(opened, p.rank);
        s.ready = opened + t_.tRCD;
        s.column = slots_.find_column(std::max(from, s.ready), now, c, p.rank, p.group);
        if (bank.refresh == never || s.column + after <= bank.refresh)
            break;
        opened = bank.refresh + t_.tRFC;
    }
    slots_.take_activate(opened, p.rank, p.group);
    log(DramCommand::Kind::activate, opened, p);
    ++counters_[p.rank].activates;
    bank.before = bank.now;
    bank.now = {p.row, s.ready, never};
    bank.activated = bank.used = opened;
    bank.precharge_from = opened + t_.tRAS;
    return s;
}

/// The column command of a burst, in the clock that open_row() found; `last` of its request in this row.
void DramChannel::send(const DramPlace& p, Column c, const Sent& s, bool last) {
    MemoryCounters& n = counters_[p.rank];
    slots_.take_column(s.column, c, p.rank, p.group);
    log(c == Column::read ? DramCommand::Kind::read : DramCommand::Kind::write, s.column, p);
    ++(s.row == Row::hit ? n.row_hits : s.row == Row::empty ? n.row_empties : n.row_conflicts);
    n.busy_clocks += t_.burst;
    n.last_clock = std::max(n.last_clock, s.column + t_.data[at(c)] + t_.burst);
    if (s.closing)
        return;
    Bank& bank = bank_of(p);
    bank.precharge_from = std::max(bank.precharge_from, s.column + t_.precharge[at(c)]);
    bank.used = std::max(bank.used, s.column);
    if (closed_page_ && last) {
        bank.now.close = bank.precharge_from;
        ++n.precharges;
        log(DramCommand::Kind::precharge, bank.now.close, p, true);
    }
}

Clock DramChannel::read(const DramPlace& place, std::uint64_t burst, Clock arrival, bool last) {
    MemoryCounters& n = counters_[place.rank];
    slots_.set_now(arrival);
    for (const Write& w : queue_)
        if (w.burst == burst && w.leaves > arrival) {
            ++n.forwarded;
            return arrival;
        }
    Sent s = open_row(place, Column::read, arrival, arrival);
    send(place, Column::read, s, last);
    Clock end = s.column + t_.data[0] + t_.burst;
    Clock own =
        t_.data[0] + t_.burst + (s.row == Row::hit ? 0 : t_.tRCD) + (s.row == Row::conflict ? t_.tRP : 0);
    ++n.read_bursts;
    n.read_clocks += end - arrival;
    n.queue_clocks += end - arrival - std::min(end - arrival, own);
    return end;
}

/// Sends writes until the low watermark, at most one row of each bank at a time: all rows are opened first,
/// so that the data follow each other without gaps that no read could use.
void DramChannel::send_batch(Clock now) {
    struct Chosen {
        Write* write;
        Sent opened;
    };
    std::vector<Chosen> batch;
    ++batch_;
    ++counters_[0].batches;
    for (Write& w : queue_) {
        Bank& bank = bank_of(w.place);
        if (w.leaves != never || batch.size() == waiting_ - low_ ||
            (bank.batch == batch_ && bank.batch_row != w.place.row))
            continue;
        bank.batch = batch_;
        bank.batch_row = w.place.row;
        batch.push_back({&w, {}});
    }
    for (Chosen& x : batch)
        x.opened = open_row(x.write->place, Column::write, now, now);
    std::stable_sort(batch.begin(), batch.end(),
                     [](const Chosen& a, const Chosen& b) { return a.opened.ready < b.opened.ready; });
    Clock each = t_.column[1][1][at(Near::rank)], from = now;
    for (std::size_t i = 0; i < batch.size(); ++i)
        from = std::max(from, batch[i].opened.ready - std::min(batch[i].opened.ready, i * each));
    from = slots_.find_room_to_write(from, batch.size() * each);
    for (auto x = batch.begin(); x != batch.end(); ++x) {
        const DramPlace& p = x->write->place;
        Sent s = open_row(p, Column::write, now, from);
        if (x->opened.row != Row::hit) { // the batch itself has opened it
            counters_[p.rank].reopened += s.row == Row::hit ? 0 : 1;
            s.row = x->opened.row;
        }
        send(p, Column::write, s, std::none_of(x + 1, batch.end(), [&](const Chosen& later) {
                 return &bank_of(later.write->place) == &bank_of(p);
             }));
        x->write->leaves = s.column + t_.data[1] + t_.burst;
        ++counters_[p.rank].write_bursts;
    }
    waiting_ -= batch.size();
}

Clock DramChannel::write(const DramPlace& place, std::uint64_t burst, Clock arrival) {
    MemoryCounters& n = counters_[place.rank];
    slots_.set_now(arrival);
    for (const Write& w : queue_)
        if (w.burst == burst && w.leaves == never) {
            ++n.merged;
            return arrival;
        }
    Clock taken = arrival;
    if (queue_.size() == capacity_) {
        std::erase_if(queue_, [arrival](const Write& w) { return w.leaves <= arrival; });
        if (queue_.size() == capacity_) {
            auto first = std::min_element(queue_.begin(), queue_.end(),
                                          [](const Write& a, const Write& b) { return a.leaves < b.leaves; });
            taken = first->leaves;
            queue_.erase(first);
        }
    }
    queue_.push_back({burst, never, place});
    n.write_wait_clocks += taken - arrival;
    if (++waiting_ >= high_)
        while (waiting_ > low_)
            send_batch(taken);
    return taken;
}

void DramChannel::drain(Clock t) {
    const std::size_t low = std::exchange(low_, 0);
    while (waiting_ > 0)
        send_batch(t);
    low_ = low;
}

Clock DramChannel::quiet() const {
    Clock end = 0;
    for (const MemoryCounters& n : counters_)
        end = std::max(end, n.last_clock);
    return end;
}

void DramChannel::count_refreshes(Clock end) {
    for (std::uint32_t rank = 0; t_.tREFI != 0 && rank < counters_.size(); ++rank)
        for (Clock r = slots_.first_refresh(rank); r < end; r += t_.tREFI) {
            if (r < refreshed_)
                continue;
            ++counters_[rank].refreshes;
            DramPlace p;
            p.channel = number_;
            p.rank = rank;
            log(DramCommand::Kind::precharge_all, r - t_.tRP, p);
            log(DramCommand::Kind::refresh, r, p);
        }
    refreshed_ = std::max(refreshed_, end);
}

std::vector<MemoryCounters> DramChannel::counters() const {
    std::vector<MemoryCounters> out = counters_;
    out[0].turnarounds = slots_.turnarounds();
    out[0].rank_switches = slots_.rank_switches();
    return out;
}

} // namespace sim
