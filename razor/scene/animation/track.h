// A value that changes in time, given by keys.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace razor {

/// Between two keys: the earlier one; straight from one to the other; or by the cubic that also takes its
/// slopes at keys from the keys on either side (Catmull and Rom 1974, for uneven times: Hermite cubics with
/// (v[i+1] - v[i-1]) / (t[i+1] - t[i-1]); at an end the slope to the next key).
enum class Interpolation : std::uint8_t { step, linear, smooth };

struct Timing {
    Interpolation interpolation = Interpolation::linear;
    /// Seconds after which all keys come again; 0: before the first key and after the last one theirs hold.
    double cycle = 0;

    bool operator==(const Timing&) const = default;
};

template <class Value> class Track {
public:
    struct Key {
        double time; // seconds
        Value value;

        bool operator==(const Key&) const = default;
    };

    /// In order of time, none twice; of a cycle: from 0 up to it.
    std::vector<Key> keys;

    bool empty() const { return keys.empty(); }
    /// At `t` seconds; there must be a key.
    Value at(double t, const Timing& timing) const {
        if (timing.cycle > 0)
            t -= timing.cycle * std::floor(t / timing.cycle);
        const auto after = static_cast<std::ptrdiff_t>(std::distance(
            keys.begin(), std::upper_bound(keys.begin(), keys.end(), t,
                                           [](double time, const Key& key) { return time < key.time; })));
        const auto count = static_cast<std::ptrdiff_t>(keys.size());
        if (timing.cycle == 0 && (after == 0 || after == count))
            return keys[static_cast<std::size_t>(after == 0 ? 0 : count - 1)].value;
        const Key a = key(after - 1, timing), b = key(after, timing);
        if (timing.interpolation == Interpolation::step || !(b.time > a.time))
            return a.value;
        const double length = b.time - a.time, x = (t - a.time) / length;
        if (timing.interpolation == Interpolation::linear)
            return a.value + (b.value - a.value) * x;
        const double y = 1 - x;
        return a.value * (y * y * (1 + 2 * x)) + b.value * (x * x * (1 + 2 * y)) +
               (slope(after - 1, timing) * (x * y * y) - slope(after, timing) * (x * x * y)) * length;
    }

    bool operator==(const Track&) const = default;

private:
    /// Also before the first and after the last, of a cycle.
    Key key(std::ptrdiff_t i, const Timing& timing) const {
        const auto count = static_cast<std::ptrdiff_t>(keys.size());
        const std::ptrdiff_t turns = i < 0 ? -1 : i / count;
        Key k = keys[static_cast<std::size_t>(i - turns * count)];
        k.time += static_cast<double>(turns) * timing.cycle;
        return k;
    }
    Value slope(std::ptrdiff_t i, const Timing& timing) const {
        const bool cyclic = timing.cycle > 0;
        const auto last = static_cast<std::ptrdiff_t>(keys.size()) - 1;
        const Key a = key(cyclic ? i - 1 : std::max<std::ptrdiff_t>(i - 1, 0), timing),
                  b = key(cyclic ? i + 1 : std::min(i + 1, last), timing);
        return b.time > a.time ? (b.value - a.value) * (1 / (b.time - a.time)) : a.value * 0.0;
    }
};

} // namespace razor
