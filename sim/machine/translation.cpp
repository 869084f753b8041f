// Addresses become physical ones: TLBs and walks through page tables (tlb.*). An operation looks up each page
// that it touches once, before its first access: in the core's TLB in no time besides the L1's, then in the
// second one. A walk reads an entry of each level of the tables that the walk cache lacks, through the core's
// L1, each address known when the entry before is there. Whoever misses on a page that a thread of the core
// is walking for waits for that walk.
// Not modelled: translation of instruction fetches, discards and what prefetchers ask for (a prefetch
// operation whose page is not in the core's TLB is dropped); looks of waiting threads; shootdowns, as pages
// never change.
#include "sim/machine/issue.h"

#include <bit>

namespace sim {

/// A thread waits for a walk of its core to end; returns from when it goes on.
cycle Engine::await_walk(Hart& h, cycle t) {
    h.core->mmu->waiting.push_back({&h, &t});
    Away away(h);
    h.tile->scheduler.park();
    h.now = std::max(h.now, t);
    come_back(h, window_end_);
    return std::max(t, h.bound.at());
}

/// Reads the tables from cycle `t` on; returns when the page's entry is there.
cycle Engine::read_tables(Hart& h, std::uint64_t page, cycle t) {
    Mmu& m = *h.core->mmu;
    const auto name = [](unsigned level, std::uint64_t p) {
        return PageTables::index(level, p) << 3U | level;
    };
    unsigned level = 1; // of the lowest table whose entry the walk cache has
    while (level < tables_->levels() && m.tables.use(name(level, page)) == nullptr)
        ++level;
    m.counters.walk_spared += tables_->levels() - level;
    const SiteAtHand site = h.site;
    h.site = {};
    while (level-- > 0) {
        t = std::max(turn(h, t), h.bound.at()); // it may have waited
        ++m.counters.walk_reads;
        Data data;
        touch_line(h, tables_->address(level, page), 8, false, 1, 1, t, data);
        t = std::max(
            {t, data.last, data.open != 0 ? await(h, data.tickets[0]).last : 0}); // t: if warming began
        if (level != 0)
            m.tables.fill(name(level, page), t);
    }
    h.site = site;
    return t;
}

/// Finds the page's translation in the tables, or as somebody else does; `t`: from when it is looked for,
/// then when it is there. False: something has changed, look again.
bool Engine::walk(Hart& h, std::uint64_t page, cycle& t) {
    Mmu& m = *h.core->mmu;
    if (const cycle free = m.walkers.free_at(t); free != t) {
        const cycle since = t;
        t = std::max(free == Walkers::unknown ? await_walk(h, t) : turn(h, free), h.bound.at());
        m.counters.walker_cycles += t - since;
        h.bound.later(Due(t, Cause::tlb)); // younger operations do not pass who waits for a walker
        return false;
    }
    ++m.counters.walks;
    m.walkers.begin(page, t, h.tile->earliest);
    const cycle end = tables_ ? read_tables(h, page, t) : t + wide(config_.tlb.walk_cycles);
    if (end != t)
        turn(h, end); // what others see of it, they see then
    m.counters.walk_cycles += end - t;
    m.walkers.end(page, end);
    m.first.fill(page, end);
    m.second.fill(page, end);
    for (const Mmu::Waiting& w : m.waiting) {
        *w.t = std::max(*w.t, end);
        h.tile->scheduler.wake(Scheduler::key(*w.t, w.hart->number));
    }
    m.waiting.clear();
    t = end;
    return true;
}

/// When an access that wants to begin at cycle `t` has its page's address.
cycle Engine::translate_page(Hart& h, std::uint64_t page, cycle t) {
    Mmu& m = *h.core->mmu;
    ++m.counters.lookups;
    const TlbArray::Entry* there = m.first.use(page);
    if (there != nullptr && there->filled <= t) {
        ++m.counters.hits;
        return t;
    }
    ++m.counters.misses;
    const cycle since = t;
    for (bool asked = false;; there = m.first.use(page)) {
        if (there != nullptr || m.walkers.under_way(page)) {
            ++m.counters.merged;
            t = there != nullptr ? std::max(t, there->filled) : await_walk(h, t);
            break;
        }
        if (!asked && config_.tlb.second_entries != 0)
            t += wide(config_.tlb.second_latency);
        asked = true;
        if (const TlbArray::Entry* below = m.second.use(page); below != nullptr) {
            ++m.counters.second_hits;
            t = std::max(t, below->filled);
            m.first.fill(page, t);
            break;
        }
        if (walk(h, page, t))
            break;
    }
    m.counters.wait_cycles += t - since;
    return t;
}

/// The thread's younger operations wait until its operation has its addresses.
cycle Engine::wait_for_address(Hart& h, cycle from, cycle t, bool holds) {
    if (t == from || !holds)
        return t;
    if (t > h.accounted) {
        h.account(h.accounted, t, Cause::tlb);
        h.accounted = t;
    }
    h.bound.later(Due(t, Cause::tlb));
    return t;
}

cycle Engine::translate(Hart& h, std::uint64_t low, std::uint64_t high, cycle from) {
    cycle t = from;
    for (std::uint64_t page = low >> page_shift_; page <= high >> page_shift_; ++page)
        t = std::max(t, translate_page(h, page, std::max(holds_misses_ ? t : from, h.bound.at())));
    return wait_for_address(h, from, t, holds_misses_);
}

cycle Engine::translate_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from) {
    const auto first = static_cast<unsigned>(std::countr_zero(lanes));
    const auto last = 63 - static_cast<unsigned>(std::countl_zero(lanes));
    return translate(h, address + 4 * std::uint64_t{first}, address + 4 * std::uint64_t{last} + 3, from);
}

/// Each page that a lane touches, in the order of the lanes.
cycle Engine::translate_indexed(Hart& h, std::uint64_t address, const std::int32_t* index,
                                std::uint64_t lanes, cycle from) {
    std::array<std::uint64_t, 2 * width> seen; // NOLINT: filled as far as used
    auto end = seen.begin();
    cycle t = from;
    for (; lanes != 0; lanes &= lanes - 1) {
        const std::uint64_t low =
            address + static_cast<std::uint64_t>(std::int64_t{index[std::countr_zero(lanes)]} * 4);
        for (std::uint64_t page = low >> page_shift_; page <= (low + 3) >> page_shift_; ++page)
            if (std::find(seen.begin(), end, page) == end) {
                *end++ = page;
                t = std::max(t, translate_page(h, page, std::max(holds_misses_ ? t : from, h.bound.at())));
            }
    }
    return wait_for_address(h, from, t, holds_misses_);
}

/// Whether a prefetch has an address; drops it otherwise.
bool Engine::may_prefetch(Hart& h, std::uint64_t address) const {
    Mmu* m = h.core->mmu.get();
    if (m == nullptr || m->first.has(address >> page_shift_))
        return true;
    ++m->counters.prefetches_dropped;
    return false;
}

} // namespace sim
