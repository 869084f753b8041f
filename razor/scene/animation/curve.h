// A quantity of several components that changes in time by keys, as glTF 2.0 has them (appendix C): unlike a
// Track, rotations turn on the sphere, and a cubic spline brings its own tangents.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace razor {

/// Between two keys: the earlier one; straight, or by the shortest turn; a cubic with tangents at both ends.
enum class CurveKind : std::uint8_t { step, linear, cubic_spline };

struct Curve {
    CurveKind kind = CurveKind::linear;
    std::size_t width = 1;     // components
    bool rotation = false;     // a quaternion x, y, z, w
    std::vector<double> times; // seconds; at least one, in order
    std::vector<double>
        values; // `width` a key; of a cubic spline: tangent in, value, tangent out (per second)

    /// `width` components; before the first key and after the last one theirs hold. Rotations have length 1.
    void at(double seconds, std::span<double> result) const;
};

} // namespace razor
