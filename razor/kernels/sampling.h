// Sample points as a deterministic function of (pixel, sample, dimension): the R2 sequence (Roberts 2018:
// multiples of the plastic constant, modulo 1) moved by a hash of pixel and dimension, so no picture depends
// on threads, tiles or sharing.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {

enum SampleDimension : int { dimension_film = 1, dimension_light = 2, dimension_sky = 3 };

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

/// The point of `sample` in [0,1)^2 for this pixel and dimension.
inline vpoint sample_square(const vint& pixel, const vint& sample, int dimension) {
    vint seed = scramble(pixel + vint(std::int32_t(0x9e3779b9U * static_cast<std::uint32_t>(dimension))));
    vint other = scramble(seed);
    vint x = sample * vint(std::int32_t(3242174889U)) + seed;  // 2^32 / p, p the plastic constant
    vint y = sample * vint(std::int32_t(2447445414U)) + other; // 2^32 / p^2
    vpoint s;
    s.u = unit(x);
    s.v = unit(y);
    return s;
}

} // namespace razor::ISA_TARGET
