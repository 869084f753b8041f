// Three non-negative numbers in 32 bits: mantissas of 9 bits, red lowest, and an exponent of 5 bits that they
// share (the format of EXT_texture_shared_exponent, OpenGL 3.0). A number is mantissa * 2^(exponent - 24);
// the largest is 65408, and each is off by at most 2^-9 of the largest of the three.
#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace razor {

inline constexpr int mantissa_bits = 9;
inline constexpr int exponent_bias = 24; // 15 + mantissa_bits
inline constexpr float most_shared = 65408.0F;

/// Rounded to nearest; what is negative or no number becomes 0, what is too large most_shared.
inline std::uint32_t pack_shared_exponent(const glm::vec3& colour) {
    glm::vec3 c;
    for (int k = 0; k < 3; ++k)
        c[k] = colour[k] > 0 ? std::min(colour[k], most_shared) : 0.0F;
    const float largest = std::max({c.x, c.y, c.z});
    // largest < 2^(exponent - 15); pictures have many texels, so without the library's frexp and ldexp
    int exponent = std::max(static_cast<int>(std::bit_cast<std::uint32_t>(largest) >> 23) - 126 + 15, 0);
    double to_mantissa =
        std::bit_cast<float>(static_cast<std::uint32_t>(127 + exponent_bias - exponent) << 23);
    const auto mantissa = [&](float value) {
        return static_cast<std::uint32_t>(double{value} * to_mantissa + 0.5); // exact
    };
    if (mantissa(largest) == 1U << mantissa_bits) { // rounded up to the next power of two
        ++exponent;
        to_mantissa /= 2;
    }
    return mantissa(c.x) | mantissa(c.y) << 9 | mantissa(c.z) << 18 |
           static_cast<std::uint32_t>(exponent) << 27;
}

inline glm::vec3 unpack_shared_exponent(std::uint32_t packed) {
    const int exponent = static_cast<int>(packed >> 27) - exponent_bias;
    const auto number = [&](int shift) {
        return std::ldexp(static_cast<float>(packed >> shift & 0x1ffU), exponent);
    };
    return {number(0), number(9), number(18)};
}

} // namespace razor
