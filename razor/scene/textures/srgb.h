// The transfer function of sRGB pictures, IEC 61966-2-1.
#pragma once

#include <cmath>

namespace razor {

/// An encoded value in [0, 1] as linear light.
inline double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

} // namespace razor
