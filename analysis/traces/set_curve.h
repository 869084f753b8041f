// Misses of set-associative LRU caches of one number of sets and several numbers of ways, in one pass.
#pragma once

#include "analysis/traces/lru_curve.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace analysis {

/// Each set is an LRU stack as deep as the most ways; lines go to sets by their number modulo `sets`.
class SetCurve {
public:
    /// `ways`: ascending.
    SetCurve(std::uint64_t sets, std::vector<std::uint64_t> ways)
        : sets_(sets), depth_(static_cast<std::size_t>(ways.back())), stacks_(sets * depth_, empty),
          counts_(std::move(ways)) {}

    /// The place in its set's stack, from 1 on; more than the most ways: not there.
    std::uint64_t touch(std::uint64_t line, std::size_t group) {
        std::uint64_t* const top = &stacks_[static_cast<std::size_t>(line % sets_) * depth_];
        std::uint64_t above = line + 1; // 0 is none
        std::size_t at = 0;
        do
            std::swap(above, top[at++]);
        while (at < depth_ && above != line + 1 && above != empty);
        const std::uint64_t place = above == line + 1 ? at : depth_ + 1;
        counts_.add(group, place);
        return place;
    }
    std::uint64_t sets() const { return sets_; }
    /// Sizes are ways; first touches count as misses like others.
    const ReuseCounts& counts() const { return counts_; }

private:
    static constexpr std::uint64_t empty = 0;
    std::uint64_t sets_;
    std::size_t depth_;
    std::vector<std::uint64_t> stacks_; // by set, from the top: lines + 1
    ReuseCounts counts_;
};

} // namespace analysis
