// A plain simulator of TLBs and page walks, written for the tests: lists of pages, the last used first.
#pragma once

#include <algorithm>
#include <cstdint>
#include <list>
#include <map>
#include <vector>

namespace sim::test {

class LruSets {
public:
    /// `ways` 0: one set.
    LruSets(std::uint64_t entries, std::uint64_t ways)
        : ways_(ways == 0 ? entries : ways), sets_(entries == 0 ? 0 : entries / ways_) {}

    bool use(std::uint64_t page) {
        if (sets_.empty())
            return false;
        std::list<std::uint64_t>& set = sets_[page % sets_.size()];
        const bool there = std::count(set.begin(), set.end(), page) != 0;
        set.remove(page);
        set.push_front(page);
        if (set.size() > ways_)
            set.pop_back();
        return there;
    }

private:
    std::uint64_t ways_;
    std::vector<std::list<std::uint64_t>> sets_;
};

struct TlbOracle {
    TlbOracle(std::uint64_t entries, std::uint64_t ways, std::uint64_t second, std::uint64_t second_ways,
              std::uint64_t walk_cache, std::uint64_t levels)
        : first(entries, ways), behind(second, second_ways), levels(levels), walk_cache(walk_cache) {}

    void look_up(std::uint64_t page) {
        ++lookups;
        if (first.use(page)) {
            ++hits;
            return;
        }
        if (behind.use(page)) {
            ++second_hits;
            return;
        }
        ++walks;
        walk(page);
    }

    LruSets first, behind;
    std::uint64_t levels, walk_cache;
    std::uint64_t lookups = 0, hits = 0, second_hits = 0, walks = 0, reads = 0;

private:
    /// The lowest table above the last that is cached tells where to begin.
    void walk(std::uint64_t page) {
        std::uint64_t from = levels - 1; // reads this level and those below
        for (std::uint64_t level = 1; level < levels; ++level) {
            const std::pair key(level, page >> (9 * level));
            if (std::count(cached_.begin(), cached_.end(), key) != 0) {
                enter(key);
                from = level - 1;
                break;
            }
        }
        reads += from + 1;
        for (std::uint64_t level = from; level > 0; --level)
            enter({level, page >> (9 * level)});
    }
    void enter(std::pair<std::uint64_t, std::uint64_t> key) {
        cached_.remove(key);
        cached_.push_front(key);
        if (cached_.size() > walk_cache)
            cached_.pop_back();
    }
    std::list<std::pair<std::uint64_t, std::uint64_t>> cached_;
};

} // namespace sim::test
