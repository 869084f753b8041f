#include "razor/scene/animation/track.h"

#include <algorithm>
#include <iterator>

namespace razor {
namespace {

/// Keys numbered on beyond the first and the last, of a cycle.
class Keys {
public:
    Keys(const std::vector<double>& times, double cycle)
        : times_(times), cycle_(cycle), count_(static_cast<std::ptrdiff_t>(times.size())) {}

    std::size_t index(std::ptrdiff_t i) const { return static_cast<std::size_t>(i - turns(i) * count_); }
    double time(std::ptrdiff_t i) const { return times_[index(i)] + static_cast<double>(turns(i)) * cycle_; }
    /// The one before or after, or itself where there is none.
    std::ptrdiff_t next(std::ptrdiff_t i, int step) const {
        return cycle_ > 0 ? i + step : std::clamp<std::ptrdiff_t>(i + step, 0, count_ - 1);
    }

private:
    std::ptrdiff_t turns(std::ptrdiff_t i) const { return i < 0 ? (i + 1) / count_ - 1 : i / count_; }

    const std::vector<double>& times_;
    double cycle_;
    std::ptrdiff_t count_;
};

} // namespace

Blend blend_at(const std::vector<double>& times, const Timing& timing, double t) {
    if (timing.cycle > 0)
        t -= timing.cycle * std::floor(t / timing.cycle);
    const auto after = static_cast<std::ptrdiff_t>(
        std::distance(times.begin(), std::upper_bound(times.begin(), times.end(), t)));
    const auto count = static_cast<std::ptrdiff_t>(times.size());
    Blend blend;
    if (timing.cycle == 0 && (after == 0 || after == count)) {
        blend.base = static_cast<std::size_t>(after == 0 ? 0 : count - 1);
        return blend;
    }
    const Keys keys(times, timing.cycle);
    const std::ptrdiff_t a = after - 1, b = after;
    const double length = keys.time(b) - keys.time(a), x = (t - keys.time(a)) / length;
    blend.base = keys.index(a);
    const auto add = [&](std::ptrdiff_t key, double factor) {
        if (factor != 0 && keys.index(key) != blend.base)
            blend.parts[blend.count++] = {keys.index(key), factor};
    };
    if (timing.interpolation == Interpolation::step || !(length > 0))
        return blend;
    if (timing.interpolation == Interpolation::linear) {
        add(b, x);
        return blend;
    }
    // Hermite's cubic, its slopes taken apart into the keys that they are made of; a, the base, has the rest.
    const double y = 1 - x;
    const std::ptrdiff_t before = keys.next(a, -1), beyond = keys.next(b, 1);
    const auto slope = [&](std::ptrdiff_t from, std::ptrdiff_t to, double weight) {
        const double seconds = keys.time(to) - keys.time(from);
        return seconds > 0 ? weight * length / seconds : 0;
    };
    const double at_a = slope(before, b, x * y * y), at_b = slope(a, beyond, -x * x * y);
    add(before, -at_a);
    add(b, x * x * (1 + 2 * y) + at_a + (beyond == b ? at_b : 0));
    if (beyond != b)
        add(beyond, at_b);
    return blend;
}

} // namespace razor
