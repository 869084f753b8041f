#include "analysis/traces/short_reuse.h"

#include "traces/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace analysis {
namespace {

constexpr std::size_t slots = 8192;
constexpr std::uint64_t seed_step = 0xD1B54A32D192ED03U; // odd, without a pattern

} // namespace

ShortReuse::ShortReuse(std::vector<std::uint64_t> sizes, double rate, std::uint64_t stretch,
                       std::uint64_t seed)
    : sizes_(std::move(sizes)), stretch_(stretch),
      period_(std::max(stretch, static_cast<std::uint64_t>(static_cast<double>(stretch) / rate))),
      seed_(seed), stack_(slots) {
    next_stretch();
}

/// Somewhere in period `number_`.
void ShortReuse::next_stretch() {
    begin_ =
        number_ * period_ + static_cast<std::uint64_t>(traces::hash_of_line(number_ + seed_ * seed_step) *
                                                       static_cast<double>(period_ - stretch_));
    end_ = begin_ + stretch_;
    stack_ = StackDistance(slots);
    ++number_;
}

void ShortReuse::look(std::uint64_t line, std::size_t group) {
    if ((group + 1) * sizes_.size() > known_.size())
        known_.resize((group + 1) * sizes_.size());
    if (group >= touches_.size())
        touches_.resize(group + 1, 0);
    ++touches_[group];
    const std::uint64_t before = stack_.lines(), distance = stack_.touch(line);
    Known* known = &known_[group * sizes_.size()];
    for (std::size_t s = 0; s < sizes_.size() && sizes_[s] <= before; ++s) {
        ++known[s].references;
        known[s].misses += distance > sizes_[s] ? 1 : 0;
    }
    if (now_ + 1 == end_)
        end_stretch();
}

void ShortReuse::end_stretch() {
    ++stretches_;
    for (Known& k : known_) {
        const auto n = static_cast<double>(std::exchange(k.references, 0));
        const auto m = static_cast<double>(std::exchange(k.misses, 0));
        k.sum_references += n;
        k.sum_misses += m;
        k.references2 += n * n;
        k.products += n * m;
        k.misses2 += m * m;
        k.stretches += n > 0 ? 1 : 0;
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
