#include "analysis/traces/short_reuse.h"

#include "traces/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace analysis {
namespace {

constexpr std::size_t slots = 4096;
constexpr std::uint64_t seed_step = 0xD1B54A32D192ED03U; // odd, without a pattern

} // namespace

ShortReuse::ShortReuse(std::vector<std::uint64_t> sizes, double rate, std::uint64_t stretch,
                       std::uint64_t seed)
    : sizes_(std::move(sizes)), stretch_(stretch),
      period_(std::max(stretch,
                       static_cast<std::uint64_t>(std::min(static_cast<double>(stretch) / rate, 0x1p62)))),
      seed_(seed), stack_(slots) {
    for (std::size_t i = 0; i < near_.size(); ++i) // in a stretch that has so many lines
        near_[i] =
            static_cast<std::size_t>(std::lower_bound(sizes_.begin(), sizes_.end(), i + 1) - sizes_.begin());
    next_stretch();
}

/// Somewhere in period `number_`.
void ShortReuse::next_stretch() {
    begin_ =
        number_ * period_ + static_cast<std::uint64_t>(traces::hash_of_line(number_ + seed_ * seed_step) *
                                                       static_cast<double>(period_ - stretch_));
    end_ = begin_ + stretch_;
    stack_ = RecentStack(slots);
    known_sizes_ = 0;
    ++number_;
}

/// How many of the sizes that something is known of miss what was touched so long ago.
std::size_t ShortReuse::missing(std::uint64_t distance) const {
    const auto known = sizes_.begin() + static_cast<std::ptrdiff_t>(known_sizes_);
    return static_cast<std::size_t>(std::lower_bound(sizes_.begin(), known, distance) - sizes_.begin());
}

/// None goes beyond the stretch at hand.
void ShortReuse::look(std::span<const std::uint64_t> lines, std::size_t group) {
    const std::size_t sizes = sizes_.size();
    if (group >= touches_.size()) {
        touches_.resize(group + 1, 0);
        known_.resize((group + 1) * sizes);
        counted_.resize((group + 1) * (sizes + 1));
    }
    touches_[group] += lines.size();
    Counted* const counted = &counted_[group * (sizes + 1)];
    for (const std::uint64_t line : lines) {
        const std::uint64_t before = stack_.lines();
        const std::uint64_t distance = stack_.touch(line);
        while (known_sizes_ < sizes && sizes_[known_sizes_] <= before)
            ++known_sizes_;
        ++counted[known_sizes_].known;
        ++counted[distance <= near_.size() ? near_[distance - 1] : missing(distance)].missing;
    }
    now_ += lines.size();
    if (now_ == end_)
        end_stretch();
}

void ShortReuse::end_stretch() {
    ++stretches_;
    const std::size_t sizes = sizes_.size();
    for (std::size_t group = 0; group < touches_.size(); ++group) {
        Counted more; // touches that know of this size, or miss it: those of all that are larger
        for (std::size_t s = sizes; s-- != 0;) {
            const Counted c = std::exchange(counted_[group * (sizes + 1) + s + 1], {});
            more.known += c.known;
            more.missing += c.missing;
            Known& k = known_[group * sizes + s];
            const auto n = static_cast<double>(more.known), m = static_cast<double>(more.missing);
            k.sum_references += n;
            k.sum_misses += m;
            k.references2 += n * n;
            k.products += n * m;
            k.misses2 += m * m;
            k.stretches += n > 0 ? 1 : 0;
        }
        counted_[group * (sizes + 1)] = {};
    }
    next_stretch();
}

ShortReuse::Estimate ShortReuse::estimate(std::size_t group, std::size_t size) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::size_t at = group * sizes_.size() + size;
    constexpr std::uint64_t least_stretches = 8;
    if (at >= known_.size() || known_[at].stretches < least_stretches ||
        known_[at].sum_references * 8 < static_cast<double>(touches_[group]))
        return {nan, nan, 0};
    const Known& k = known_[at];
    // The ratio estimator of sampled clusters (Cochran, Sampling Techniques, 1977, 6.3); Student's t by the
    // expansion of Cornish and Fisher.
    const double r = k.sum_misses / k.sum_references, n = static_cast<double>(k.stretches), f = n - 1;
    const double spread = std::max(0.0, k.misses2 - 2 * r * k.products + r * r * k.references2);
    const double student = 1.96 + 2.372 / f + 2.823 / (f * f) + 2.556 / (f * f * f) + 3.0 / (f * f * f * f);
    return {r, student * std::sqrt(n / f * spread) / k.sum_references,
            static_cast<std::uint64_t>(k.sum_references)};
}

} // namespace analysis
