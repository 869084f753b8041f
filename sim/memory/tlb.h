// Translations of pages that a core, or several, keep: LRU within a set. Those whose walk ends in the future
// of a thread that lags behind say so.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

class TlbArray {
public:
    struct Entry {
        std::uint64_t page = ~std::uint64_t{0};
        cycle filled = 0; // from when it is there
    };

    /// `ways` 0: any entry takes any page; else the number of sets is a power of two.
    TlbArray(std::size_t entries, std::size_t ways)
        : entries_(entries), ways_(ways == 0 || entries == 0 ? entries : ways),
          sets_(entries == 0 ? 1 : entries / ways_) {}

    /// The page's entry, the last one used from now on; nullptr: it is not here.
    const Entry* use(std::uint64_t page) {
        Entry* const set = set_of(page);
        Entry* const end = set + ways_;
        Entry* const there = std::find_if(set, end, [page](const Entry& e) { return e.page == page; });
        if (there == end)
            return nullptr;
        std::rotate(set, there, there + 1);
        return set;
    }
    bool has(std::uint64_t page) const {
        const Entry* const set = const_cast<TlbArray*>(this)->set_of(page);
        return std::any_of(set, set + ways_, [page](const Entry& e) { return e.page == page; });
    }
    /// In place of the least recently used of its set.
    void fill(std::uint64_t page, cycle filled) {
        if (ways_ == 0)
            return;
        Entry* const set = set_of(page);
        if (use(page) == nullptr)
            std::rotate(set, set + ways_ - 1, set + ways_);
        *set = {page, filled};
    }

private:
    Entry* set_of(std::uint64_t page) { return entries_.data() + (page & (sets_ - 1)) * ways_; }

    std::vector<Entry> entries_; // set by set, each the most recently used first
    std::size_t ways_, sets_;
};

/// The walks of a core through the page tables: so many at once, one a page.
class Walkers {
public:
    static constexpr cycle unknown = ~cycle{0};

    explicit Walkers(std::size_t count) : count_(count) {}

    /// The first cycle from `t` on at which another walk may begin; unknown: not before one ends.
    cycle free_at(cycle t) const {
        for (;;) {
            std::size_t busy = 0;
            cycle next = unknown;
            for (const Walk& w : walks_)
                if (w.from <= t && w.until > t) {
                    ++busy;
                    next = std::min(next, w.until);
                }
            if (busy < count_ || next == unknown)
                return busy < count_ ? t : unknown;
            t = next;
        }
    }
    bool under_way(std::uint64_t page) const {
        return std::any_of(walks_.begin(), walks_.end(),
                           [page](const Walk& w) { return w.page == page && w.until == unknown; });
    }
    /// Nobody asks for cycles before `earliest`.
    void begin(std::uint64_t page, cycle from, cycle earliest) {
        std::erase_if(walks_, [earliest](const Walk& w) { return w.until <= earliest; });
        walks_.push_back({page, from, unknown});
    }
    void end(std::uint64_t page, cycle until) {
        std::find_if(walks_.begin(), walks_.end(), [page](const Walk& w) {
            return w.page == page && w.until == unknown;
        })->until = until;
    }

private:
    struct Walk {
        std::uint64_t page;
        cycle from, until; // unknown: it goes on
    };
    std::size_t count_;
    std::vector<Walk> walks_;
};

} // namespace sim
