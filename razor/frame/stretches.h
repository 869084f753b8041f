// What workers have left of the screen. Tiles lie along a curve (razor/kernels/screen_curve.h); each worker
// begins with a *stretch* of it and takes *runs* of tiles from its front, and who has none left takes the
// back half of another's. A stretch is one word, so that one compare-and-swap takes or steals: where it
// begins in the upper bits, and its length as a floating-point number of stretch_mantissa bits. Runs are what
// leaves a length that can be written: one tile at the end, some 256th of what is left before.
#pragma once

#include "isa/memory_types.h"

#include <bit>
#include <cstdint>

namespace razor {

inline constexpr int stretch_mantissa = 8;
inline constexpr int stretch_bits = 13; // of the length: lengths to 2^18 and some
/// Strides of a whole screen at most: where a stretch begins fits into what is left of 31 bits, though the
/// last one may be rounded up.
inline constexpr int most_strides = (1 << (31 - stretch_bits)) - 1024;

/// A line of its own for each.
struct alignas(64) StretchRecord {
    isa::shared<std::int32_t> left;
    std::int32_t padding[15];
};
static_assert(sizeof(StretchRecord) == 64);

/// The bits of the largest float below 1, cut off where the mantissa ends: length 0.
inline constexpr std::int32_t stretch_bias = (127 << stretch_mantissa) - 1;
inline constexpr int stretch_shift = 23 - stretch_mantissa;

/// The word of a stretch, its length rounded down to one that can be written (0 ... 511: all).
inline std::int32_t pack_stretch(std::int32_t begin, std::int32_t length) {
    const std::int32_t bits = std::bit_cast<std::int32_t>(static_cast<float>(length)) >> stretch_shift;
    return begin << stretch_bits | (length > 0 ? bits - stretch_bias : 0);
}
inline std::int32_t stretch_begin(std::int32_t word) {
    return word >> stretch_bits;
}
inline std::int32_t stretch_length(std::int32_t word) {
    const std::int32_t code = word & ((1 << stretch_bits) - 1);
    return static_cast<std::int32_t>(std::bit_cast<float>((code + stretch_bias) << stretch_shift));
}

} // namespace razor
