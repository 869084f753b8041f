#include "analysis/traces/sampled_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

/// Long enough for caches of as many lines as a sample of lines knows nothing of, times ten.
std::uint64_t stretch_of(double rate) {
    return static_cast<std::uint64_t>(std::clamp(80 / rate, 2048.0, 262144.0));
}

} // namespace

SampledCurve::SampledCurve(const std::vector<std::uint64_t>& sizes, double rate, double of,
                           std::uint64_t most, std::uint64_t seed)
    : sizes_(sizes), shards_(sizes, rate, of, most, seed) {
    constexpr double hundredth = 0.01;
    constexpr std::uint64_t short_stretch = 2048, long_stretch = 65536;
    if (of < 1)
        return;
    if (most == 0) {
        stretches_.emplace_back(sizes, rate, stretch_of(rate), seed);
        stretches_.emplace_back(sizes, rate / 2, stretch_of(rate) / 8, seed); // while those are too few
    } else {
        stretches_.emplace_back(sizes, hundredth, short_stretch, seed);
        stretches_.emplace_back(sizes, hundredth, long_stretch, seed);
    }
}

SampledCurve::Estimate SampledCurve::estimate(std::size_t group, std::size_t size) const {
    const Shards::Estimate lines = shards_.estimate(group, size);
    if (shards_.rate() == 1 || static_cast<double>(sizes_[size]) * shards_.rate() >= fewest)
        return {lines.ratio, lines.error, true};
    for (const ShortReuse& s : stretches_)
        if (const ShortReuse::Estimate e = s.estimate(group, size); e.references != 0)
            return {e.ratio, e.error, false};
    return {lines.ratio, std::numeric_limits<double>::quiet_NaN(), true};
}

} // namespace analysis
