// Exact LRU stack distances in one pass (Mattson et al. 1970, by counting marks of last touches: Bennett and
// Kruskal 1975, Olken 1981).
#pragma once

#include "analysis/traces/line_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace analysis {

/// Time is a row of slots, a touch takes the next one, and a line's last touch is marked: the lines touched
/// since are the marks behind it. Marks are counted by words, and groups of words by a Fenwick tree; full
/// rows are packed.
class StackDistance {
public:
    static constexpr std::uint64_t first = std::numeric_limits<std::uint64_t>::max();

    /// With room for so many touches at first, a multiple of 512: few where few lines are to stay in fast
    /// memory.
    explicit StackDistance(std::size_t least_slots = std::size_t{1} << 16)
        : least_slots_(least_slots),
          slots_(std::min(LineMap::most_at_first, std::bit_ceil(least_slots / 4))) {
        reserve(least_slots_);
    }

    /// The place of a line in the LRU stack, from 1 on, before it goes to the top: a fully associative LRU
    /// cache of so many lines hits, a smaller one misses. `first`: it was never touched.
    std::uint64_t touch(std::uint64_t line) {
        if (next_ == owners_.size())
            pack();
        std::uint32_t& slot = slots_[line];
        std::uint64_t distance = first;
        if (slot != LineMap::none) {
            distance = marks_from(slot);
            unmark(slot);
        }
        slot = next_;
        owners_[next_] = line;
        mark();
        return distance;
    }
    /// A line that was touched never was.
    void forget(std::uint64_t line) {
        unmark(slots_[line]);
        slots_.erase(line);
    }
    /// Different ones that were touched.
    std::uint64_t lines() const { return slots_.size(); }

protected:
    // For a stack whose top somebody else keeps: lines in it are known, but not marked.

    /// The place of a line in the whole stack; it is not marked any more, and belongs to the top.
    std::uint64_t take(std::uint64_t line) {
        std::uint32_t& slot = slots_[line];
        std::uint64_t distance = first;
        if (slot != LineMap::none) {
            distance = marks_from(slot); // and all lines of the top, which have no marks but are counted
            unmark(slot);
        }
        slot = 0; // known
        return distance;
    }
    /// The last line of the top leaves it.
    void put(std::uint64_t line) {
        if (next_ == owners_.size())
            pack();
        slots_[line] = next_;
        owners_[next_] = line;
        mark();
    }
    void forget_unmarked(std::uint64_t line) { slots_.erase(line); }

private:
    static constexpr std::size_t group_words = 8, group_slots = group_words * 64;

    void reserve(std::size_t slots);
    void pack();
    /// Marks at slot and behind it.
    std::uint64_t marks_from(std::uint32_t slot) const {
        const std::size_t word = slot / 64, group = slot / group_slots;
        std::uint64_t n = static_cast<std::uint64_t>(std::popcount(words_[word] >> (slot % 64)));
        for (std::size_t w = word + 1; w < (group + 1) * group_words; ++w)
            n += static_cast<std::uint64_t>(std::popcount(words_[w]));
        std::uint64_t before = 0; // of all groups up to this one
        for (std::size_t g = group + 1; g != 0; g &= g - 1)
            before += tree_[g];
        return n + slots_.size() - before;
    }
    void unmark(std::uint32_t slot) {
        words_[slot / 64] &= ~(std::uint64_t{1} << (slot % 64));
        for (std::size_t g = slot / group_slots + 1; g < tree_.size(); g += g & (0 - g))
            --tree_[g];
    }
    void mark() {
        words_[next_ / 64] |= std::uint64_t{1} << (next_ % 64);
        for (std::size_t g = next_ / group_slots + 1; g < tree_.size(); g += g & (0 - g))
            ++tree_[g];
        ++next_;
    }

    std::size_t least_slots_;
    LineMap slots_;                     // of lines
    std::vector<std::uint64_t> owners_; // of slots: lines
    std::vector<std::uint64_t> words_;  // marks
    std::vector<std::uint32_t> tree_;   // from 1 on
    std::uint32_t next_ = 0;
};

} // namespace analysis
