// A value that changes in time, given by keys.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// What keys have to do with a moment: v[base] + the sum of factor (v[key] - v[base]). Keys whose values are
/// equal so give just that; factors are not 0.
struct Blend {
    struct Part {
        std::size_t key = 0;
        double factor = 0;
    };

    std::size_t base = 0;
    std::array<Part, 3> parts{};
    std::size_t count = 0; // of parts
};

/// At `t` seconds, of keys at these times: in order, none twice; of a cycle: from 0 up to it. There must be
/// one.
Blend blend_at(const std::vector<double>& times, const Timing& timing, double t);

template <class Value> class Track {
public:
    struct Key {
        double time; // seconds
        Value value;

        bool operator==(const Key&) const = default;
    };

    std::vector<Key> keys; // see blend_at()

    bool empty() const { return keys.empty(); }
    /// At `t` seconds; there must be a key.
    Value at(double t, const Timing& timing) const {
        std::vector<double> times;
        for (const Key& key : keys)
            times.push_back(key.time);
        const Blend blend = blend_at(times, timing, t);
        Value value = keys[blend.base].value;
        for (std::size_t i = 0; i < blend.count; ++i)
            value += (keys[blend.parts[i].key].value - keys[blend.base].value) * blend.parts[i].factor;
        return value;
    }

    bool operator==(const Track&) const = default;
};

} // namespace razor
