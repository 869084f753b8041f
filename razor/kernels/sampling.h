// Sample points as a deterministic function of (pixel, sample, dimension): the R2 sequence (Roberts 2018:
// multiples of the plastic constant, modulo 1) moved by a hash of pixel and dimension, so no picture depends
// on threads, tiles or sharing. A seed moves the numbers of pixels (FrameHeader::sample_seed). What goes with
// what in two dimensions is by chance: of all but film and lens the sequence is taken in an order of its own
// (as Burley, Practical Hash-based Owen Scrambling, JCGT 2020, does with Sobol's; else a sample's place on a
// light would be that in its pixel, moved, and no number of samples would show the pixel as it is).
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

/// The place of a number in an order of 32-bit numbers that belongs to `key` and `factor`, which is odd: a
/// permutation that leaves each aligned block of 2^k numbers together (a nested shuffle), so that what
/// samples of a block have in common stays. Bits are turned over by hashes of all bits above them (multiplied
/// by a number of chance, the highest bits of the product).
inline vint shuffled(const vint& number, const vint& key, const vint& factor) {
    vint x = number ^ key;
    for (const int bits : {12, 8, 5, 3, 2, 1}) { // so many are turned over, by the same hash
        vint hash = shift_right_logical(x, bits) * factor;
        x = x ^ shift_right_logical(hash, 32 - bits);
    }
    return x;
}

struct vpoint {
    vfloat u, v;
};

/// How a dimension takes the sequence: as it is; on the lens, by other steps, since with the film's a place
/// on one would always go with the same place on the other; or in an order of its own.
enum class Order { film, lens, own };

/// The point of `sample` of the sequence that begins at a place of its own for each `key`.
inline vpoint sequence_point(const vint& key, const vint& sample, Order order) {
    vint seed = scramble(key);
    vint other = scramble(seed);
    vint number = order == Order::own ? shuffled(sample, seed, other | vint(1)) : sample;
    // 2^32 / p and 2^32 / p^2, p the plastic constant; on the lens 2^32 (sqrt(2) - 1) and 2^32 (sqrt(3) - 1).
    const bool lens = order == Order::lens;
    vint x = number * vint(std::int32_t(lens ? 1779033703U : 3242174889U)) + seed;
    vint y = number * vint(std::int32_t(lens ? 3144134277U : 2447445414U)) + other;
    vpoint s;
    s.u = unit(x);
    s.v = unit(y);
    return s;
}

inline constexpr std::uint32_t dimension_step = 0x9e3779b9U;

/// The point of `sample` in [0,1)^2 for this pixel and dimension.
inline vpoint sample_square(const vint& pixel, const vint& sample, int dimension) {
    vint key = pixel + vint(std::int32_t(dimension_step * static_cast<std::uint32_t>(dimension)));
    return sequence_point(key, sample,
                          dimension == dimension_film   ? Order::film
                          : dimension == dimension_lens ? Order::lens
                                                        : Order::own);
}
/// The same of a dimension that is known only as the kernel runs, and is neither film nor lens.
inline vpoint sample_square(const vint& pixel, const vint& sample, sint dimension) {
    sint apart = dimension * std::int32_t(dimension_step);
    return sequence_point(pixel + vint(apart), sample, Order::own);
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
