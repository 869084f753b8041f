#include "analysis/traces/shards.h"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

/// In the sample, a cache of n lines has n * rate; what is less than one still holds the line at hand.
std::uint64_t scaled(std::uint64_t distance, double rate) {
    if (distance == StackDistance::first)
        return distance;
    return static_cast<std::uint64_t>(std::ceil(static_cast<double>(distance - 1) / rate)) + 1;
}

} // namespace

Shards::Shards(const std::vector<std::uint64_t>& sizes, double rate, double of)
    : rate_(rate), of_(of), limit_(static_cast<std::uint64_t>(std::ceil(rate * 0x1p53))), counts_(sizes),
      part_stacks_(parts), part_counts_(parts, ReuseCounts(sizes)) {}

void Shards::take(std::uint64_t line, std::size_t group, std::uint64_t hash) {
    ++sampled_;
    counts_.add(group, scaled(stack_.touch(line), rate_));
    const std::size_t part = hash % parts; // the low bits, of which the sample knows nothing
    part_counts_[part].add(group, scaled(part_stacks_[part].touch(line), rate_ / parts));
}

/// Misses of a sample for each reference that it should have.
double Shards::ratio(const ReuseCounts& counts, double rate, std::size_t group, std::size_t size) const {
    return static_cast<double>(counts.misses(group, size)) /
           (static_cast<double>(references(group)) * rate / of_);
}

Shards::Estimate Shards::estimate(std::size_t group, std::size_t size) const {
    constexpr double student = 2.131; // 0.975 quantile, 15 degrees of freedom
    if (references(group) == 0)
        return {};
    double sum = 0, squares = 0;
    for (const ReuseCounts& part : part_counts_) {
        const double r = ratio(part, rate_ / parts, group, size);
        sum += r;
        squares += r * r;
    }
    const double n = parts, variance = std::max(0.0, squares - sum * sum / n) / (n - 1);
    // A sample of all lines leaves nothing to chance.
    return {std::clamp(ratio(counts_, rate_, group, size), 0.0, 1.0),
            student * std::sqrt((1 - rate_) * variance / n)};
}

} // namespace analysis
