// Misses of fully associative LRU caches of many sizes, in one pass, by groups of references.
#pragma once

#include "analysis/traces/stack_distance.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace analysis {

/// References by the smallest of some caches that hits them, for each of some groups, which may grow. Counts
/// are whole numbers, or sums of weights.
template <class Count> class BasicReuseCounts {
public:
    /// `sizes`: lines, ascending.
    explicit BasicReuseCounts(std::vector<std::uint64_t> sizes)
        : sizes_(std::move(sizes)), row_(sizes_.size() + 2) {}

    void add(std::size_t group, std::uint64_t distance, Count weight = 1) {
        add_at(group, column_of(distance), weight);
    }
    /// The smallest size that hits, or what stands for more.
    std::size_t column_of(std::uint64_t distance) const {
        return distance == StackDistance::first
                   ? row_ - 1
                   : static_cast<std::size_t>(std::lower_bound(sizes_.begin(), sizes_.end(), distance) -
                                              sizes_.begin());
    }
    void add_at(std::size_t group, std::size_t column, Count weight) {
        const std::size_t at = group * row_ + column;
        if (at >= counts_.size())
            counts_.resize((group + 1) * row_, 0);
        counts_[at] += weight;
    }
    const std::vector<std::uint64_t>& sizes() const { return sizes_; }
    /// Hit by that size, not by the one before; at sizes().size(): by none of them.
    Count at(std::size_t group, std::size_t size) const {
        const std::size_t at = group * row_ + size;
        return at < counts_.size() ? counts_[at] : 0;
    }
    /// To lines that were never touched before.
    Count firsts(std::size_t group) const { return at(group, row_ - 1); }
    Count references(std::size_t group) const { return at(group, 0) + misses(group, 0); }
    Count misses(std::size_t group, std::size_t size) const {
        Count n = 0;
        for (std::size_t column = size + 1; column < row_; ++column)
            n += at(group, column);
        return n;
    }

private:
    std::vector<std::uint64_t> sizes_;
    std::size_t row_;
    std::vector<Count> counts_; // by group, then by size, larger ones, first touches
};

using ReuseCounts = BasicReuseCounts<std::uint64_t>;

class LruCurve {
public:
    explicit LruCurve(std::vector<std::uint64_t> sizes) : counts_(std::move(sizes)) {}

    void touch(std::uint64_t line, std::size_t group) { counts_.add(group, stack_.touch(line)); }
    const ReuseCounts& counts() const { return counts_; }
    std::uint64_t lines() const { return stack_.lines(); }

private:
    StackDistance stack_;
    ReuseCounts counts_;
};

} // namespace analysis
