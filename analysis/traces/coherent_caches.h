// LRU caches that keep each other coherent, and who watches what becomes of the lines in them. Writes
// allocate, and drop the line from all other caches (write-invalidate, as MSI and MESI do). Not modelled:
// time, write-backs, prefetches, several levels.
#pragma once

#include "analysis/traces/line_map.h"
#include "analysis/traces/touches.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace analysis {

/// Of each cache; lines go to sets by their number modulo `sets`. Fully associative: one set.
struct CacheShape {
    std::uint64_t sets = 1, ways = 1, line_bytes = 64;
    std::uint64_t lines() const { return sets * ways; }
};

/// A line in a cache that has it, or had it.
struct Copy {
    std::uint32_t cache = 0;
    std::uint32_t group = 0;   // of the touch that brought it last
    std::uint64_t touches = 0; // since then
    std::uint64_t used =
        0; // parts of the line touched since then, a bit each: 64ths of a line, at least bytes
    std::uint64_t news = 0;    // parts that were written elsewhere between when it was lost and then
    std::uint64_t foreign = 0; // while it is away: parts written elsewhere since it was lost
    bool there = false;
    bool fresh = true;                // it comes for the first time
    bool dropped = false;             // it was lost by a write elsewhere, and without it would still be there
    bool marked = false, met = false; // an observer's own
    std::uint32_t newer = LineMap::none, older = LineMap::none; // in its set, while it is there or dropped
    std::uint32_t next = LineMap::none;                         // copy of the line
};

/// A line that any cache has had.
struct HeldLine {
    std::uint64_t line = 0;
    std::uint32_t group = 0;              // that touched it first
    std::uint32_t caches = 0;             // that have it now
    std::uint32_t copies = LineMap::none; // the first of them
};

/// Observer: filled(line, copy, touch) when a copy comes (`fresh` and `dropped` as they were, `news` new,
/// `used` still 0), used(copy, parts) at each touch, also at that one, left(line, copy) when it goes, also at
/// the end. Keeps some 80 bytes for each line and cache that ever touches it.
template <class Observer> class CoherentCaches {
public:
    CoherentCaches(CacheShape shape, Observer observer)
        : shape_(shape), observer_(std::move(observer)),
          part_shift_(static_cast<unsigned>(std::max(0, std::countr_zero(shape.line_bytes) - 6))) {}

    /// By a cache, of numbers from 0 on.
    void touch(const Touch& touch, std::uint32_t cache) {
        if (cache >= caches_) {
            caches_ = cache + 1;
            sets_.resize(caches_ * static_cast<std::size_t>(shape_.sets));
        }
        const std::uint32_t number = number_of(touch), at = copy_of(number, cache);
        HeldLine& line = lines_[number];
        Copy& copy = copies_[at];
        Set& set = set_of(cache, touch.line);
        if (!copy.there) {
            if (copy.dropped)
                unlink(set, at);
            if (set.held == shape_.ways)
                evict(set.oldest);
            copy.there = true;
            copy.group = touch.group;
            copy.touches = copy.used = 0;
            copy.news = std::exchange(copy.foreign, 0);
            ++line.caches;
            observer_.filled(line, copy, touch);
            copy.fresh = copy.dropped = false;
            ++set.held;
            link(set, at);
            forget_dropped(set);
        } else if (set.newest != at) {
            unlink(set, at);
            link(set, at);
            forget_dropped(set);
        }
        const std::uint64_t parts = parts_of(touch);
        copy.used |= parts;
        ++copy.touches;
        observer_.used(copy, parts);
        if (touch.writes && (copies_[line.copies].next != LineMap::none))
            for (std::uint32_t other = line.copies; other != LineMap::none; other = copies_[other].next)
                if (other != at) {
                    copies_[other].foreign |= parts;
                    if (copies_[other].there) {
                        copies_[other].dropped = true; // it keeps its place in the order
                        take_out(number, other);
                    }
                }
    }
    /// All copies go.
    void finish() {
        for (std::uint32_t at = 0; at < copies_.size(); ++at)
            if (copies_[at].there)
                evict(at);
    }
    /// Of a line, in a cache; null: it never had it.
    const Copy* find(std::uint64_t line, std::uint32_t cache) const {
        const std::uint32_t number = numbers_.find(line);
        std::uint32_t at = number == LineMap::none ? LineMap::none : lines_[number].copies;
        while (at != LineMap::none && copies_[at].cache != cache)
            at = copies_[at].next;
        return at == LineMap::none ? nullptr : &copies_[at];
    }

    const CacheShape& shape() const { return shape_; }
    /// That were used.
    std::uint64_t caches() const { return caches_; }
    unsigned part_shift() const { return part_shift_; }
    Observer& observer() { return observer_; }
    const Observer& observer() const { return observer_; }

private:
    struct Set {
        std::uint64_t held = 0;                                       // copies that are there
        std::uint32_t newest = LineMap::none, oldest = LineMap::none; // of these and of dropped ones
    };
    Set& set_of(std::uint32_t cache, std::uint64_t line) {
        return sets_[static_cast<std::size_t>(cache * shape_.sets + line % shape_.sets)];
    }
    std::uint64_t parts_of(const Touch& touch) const {
        const std::uint64_t low = touch.low >> part_shift_, high = touch.high >> part_shift_;
        return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (63 - high));
    }
    std::uint32_t number_of(const Touch& touch) {
        const auto fresh = static_cast<std::uint32_t>(lines_.size());
        std::uint32_t& number = numbers_[touch.line];
        if (number == LineMap::none) {
            number = fresh;
            lines_.push_back({touch.line, touch.group, 0, LineMap::none});
        }
        return number;
    }
    std::uint32_t copy_of(std::uint32_t number, std::uint32_t cache) {
        std::uint32_t at = lines_[number].copies;
        while (at != LineMap::none && copies_[at].cache != cache)
            at = copies_[at].next;
        if (at == LineMap::none) {
            at = static_cast<std::uint32_t>(copies_.size());
            copies_.emplace_back();
            copies_[at].cache = cache;
            copies_[at].next = std::exchange(lines_[number].copies, at);
            line_of_.push_back(number);
        }
        return at;
    }
    void evict(std::uint32_t at) {
        unlink(set_of(copies_[at].cache, lines_[line_of_[at]].line), at);
        take_out(line_of_[at], at);
    }
    void take_out(std::uint32_t number, std::uint32_t at) {
        Copy& copy = copies_[at];
        --set_of(copy.cache, lines_[number].line).held;
        copy.there = false;
        --lines_[number].caches;
        observer_.left(lines_[number], copy);
    }
    /// Once a set is full of copies that are newer than one that was dropped, that one would be gone as well.
    void forget_dropped(Set& set) {
        while (set.held == shape_.ways && copies_[set.oldest].dropped) {
            copies_[set.oldest].dropped = false;
            unlink(set, set.oldest);
        }
    }
    void link(Set& set, std::uint32_t at) {
        Copy& copy = copies_[at];
        copy.newer = LineMap::none;
        copy.older = set.newest;
        (set.newest == LineMap::none ? set.oldest : copies_[set.newest].newer) = at;
        set.newest = at;
    }
    void unlink(Set& set, std::uint32_t at) {
        const Copy& copy = copies_[at];
        (copy.newer == LineMap::none ? set.newest : copies_[copy.newer].older) = copy.older;
        (copy.older == LineMap::none ? set.oldest : copies_[copy.older].newer) = copy.newer;
    }

    CacheShape shape_;
    Observer observer_;
    unsigned part_shift_; // of bytes of a line, to its part
    std::uint64_t caches_ = 0;
    LineMap numbers_;
    std::vector<HeldLine> lines_;
    std::vector<Copy> copies_;
    std::vector<std::uint32_t> line_of_; // of copies
    std::vector<Set> sets_;              // by cache and set
};

} // namespace analysis
