// Sample points as a deterministic function of (pixel, sample, dimension): the R2 sequence (Roberts 2018:
// multiples of the plastic constant, modulo 1) moved by a hash of pixel and dimension, so no picture depends
// on threads, tiles or sharing. A seed moves the numbers of pixels (FrameHeader::sample_seed).
#pragma once

#include "isa/math.h"
#include "razor/frame/layout.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {

/// A permutation of 32-bit integers with good avalanche (after O'Neill's PCG output function RXS-M-XS).
inline vint scramble(const vint& x) {
    vint state = x * vint(747796405);
    state = state + vint(std::int32_t(2891336453U));
    vint amount = shift_right_logical(state, 28) + vint(4);
    vint word = shift_right_logical(state, amount) ^ state;
    word = word * vint(277803737);
    return shift_right_logical(word, 22) ^ word;
}

/// The upper 24 bits as a number in [0, 1): exact.
inline vfloat unit(const vint& bits) {
    return to_float(shift_right_logical(bits, 8)) * (1.0F / 16777216.0F);
}

struct vpoint {
    vfloat u, v;
};

/// The point of `sample` of the sequence that begins at a place of its own for each `key`. On the lens, with
/// the film's steps, a place on one would always go with the same place on the other.
inline vpoint sequence_point(const vint& key, const vint& sample, bool lens) {
    vint seed = scramble(key);
    vint other = scramble(seed);
    // 2^32 / p and 2^32 / p^2, p the plastic constant; on the lens 2^32 (sqrt(2) - 1) and 2^32 (sqrt(3) - 1).
    vint x = sample * vint(std::int32_t(lens ? 1779033703U : 3242174889U)) + seed;
    vint y = sample * vint(std::int32_t(lens ? 3144134277U : 2447445414U)) + other;
    vpoint s;
    s.u = unit(x);
    s.v = unit(y);
    return s;
}

inline constexpr std::uint32_t dimension_step = 0x9e3779b9U;

/// The point of `sample` in [0,1)^2 for this pixel and dimension.
inline vpoint sample_square(const vint& pixel, const vint& sample, int dimension) {
    vint key = pixel + vint(std::int32_t(dimension_step * static_cast<std::uint32_t>(dimension)));
    return sequence_point(key, sample, dimension == dimension_lens);
}
/// The same of a dimension that is known only as the kernel runs, and is not the lens.
inline vpoint sample_square(const vint& pixel, const vint& sample, sint dimension) {
    sint apart = dimension * std::int32_t(dimension_step);
    return sequence_point(pixel + vint(apart), sample, false);
}

/// From the unit square to the unit disk: squares about the middle become circles, and equal areas stay equal
/// (Shirley & Chiu, A Low Distortion Map Between Disk and Square, 1997).
inline vpoint concentric_disk(const vpoint& square) {
    vfloat x = fma(square.u, 2.0F, -1.0F);
    vfloat y = fma(square.v, 2.0F, -1.0F);
    vfloat width = abs(x);
    vmask steep = abs(y) > width;
    vfloat radius = select(steep, y, x);
    vfloat other = select(steep, x, y);
    vmask middle = radius == vfloat(0.0F);
    vfloat angle = other / select(middle, vfloat(1.0F), radius);
    angle = angle * 0.78539816339744830962F;
    vfloat along = radius * cos(angle);
    vfloat across = radius * sin(angle);
    return {select(steep, across, along), select(steep, along, across)};
}

} // namespace razor::ISA_TARGET
