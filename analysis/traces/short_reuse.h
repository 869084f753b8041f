// What small LRU caches miss, from stretches of a trace: what SHARDS cannot see, whose samples have hardly
// any line between two touches that are near each other. Sampling in time (Laha, Patel and Iyer, IEEE
// Transactions on Computers 1988; what is unknown at the beginning of a stretch: Wood, Hill and Kessler,
// SIGMETRICS 1991).
#pragma once

#include "analysis/traces/recent_stack.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace analysis {

/// Of each period of touches one stretch is looked at, where a hash of the period's number says. In a stretch
/// distances are exact from when as many different lines were touched in it as a cache has: from there on,
/// what was not touched in it is a miss. So nothing is assumed of what caches hold at its beginning.
class ShortReuse {
public:
    /// `sizes`: lines, ascending. `rate`: of all touches that are looked at, in (0, 1]; stretches of so many.
    /// `seed`: of which stretches.
    ShortReuse(std::vector<std::uint64_t> sizes, double rate, std::uint64_t stretch, std::uint64_t seed = 0);

    void touch(std::uint64_t line, std::size_t group) {
        if (now_ >= begin_)
            look({&line, 1}, group);
        else
            ++now_;
    }
    /// All of these, as touch() of each.
    void touch(std::span<const std::uint64_t> lines, std::size_t group) {
        while (!lines.empty()) {
            const bool looks = now_ >= begin_;
            const auto n = static_cast<std::size_t>(
                std::min<std::uint64_t>(lines.size(), (looks ? end_ : begin_) - now_));
            if (looks)
                look(lines.first(n), group);
            else
                now_ += n;
            lines = lines.subspan(n);
        }
    }

    /// Misses a reference of a group, of a cache of sizes[size] lines; half of the interval that has them in
    /// 19 of 20 cases, by how stretches differ; and of how many references it is. Not-a-number: nothing is
    /// known.
    struct Estimate {
        double ratio, error;
        std::uint64_t references;
    };
    Estimate estimate(std::size_t group, std::size_t size) const;
    /// Stretches that are whole.
    std::uint64_t stretches() const { return stretches_; }

private:
    /// Touches of the stretch at hand, of a group, by how many of the sizes (the first ones) something is
    /// known of, and by how many of these miss.
    struct Counted {
        std::uint64_t known = 0, missing = 0;
    };
    struct Known { // of a group and size: sums over stretches
        double sum_references = 0, sum_misses = 0, references2 = 0, products = 0, misses2 = 0;
        std::uint64_t stretches = 0; // in which there were references
    };
    void look(std::span<const std::uint64_t> lines, std::size_t group);
    std::size_t missing(std::uint64_t distance) const;
    void end_stretch();
    void next_stretch();

    std::vector<std::uint64_t> sizes_;
    std::uint64_t stretch_, period_, seed_;
    std::uint64_t now_ = 0, number_ = 0, begin_ = 0, end_ = 0; // touches; of the stretch at hand or next
    std::uint64_t stretches_ = 0;
    RecentStack stack_;
    std::array<std::size_t, RecentStack::most> near_{}; // missing() of distances 1, 2, ...
    std::size_t known_sizes_ = 0;                       // of no more lines than the stretch has by now
    std::vector<Counted> counted_;                      // by group, then by number of sizes
    std::vector<Known> known_;                          // by group, then by size
    std::vector<std::uint64_t> touches_;                // by group, in stretches
};

} // namespace analysis
