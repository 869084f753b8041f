// Textures that are functions: gradient noise (Perlin, Improving Noise, 2002) summed over octaves, and what
// is made of it (Perlin, An Image Synthesizer, 1985; Peachey, Solid Texturing of Complex Surfaces, 1985);
// checkers and bricks. Each is seen through a box of the width that a ray asks for: steps by their integrals,
// octaves that are too fine by their means (Norton, Rockwood & Skolmoski, Clamping, 1982).
#pragma once

#include "isa/math.h"
#include "razor/kernels/sampling.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// At most: coordinates of cells are 32 bits.
inline constexpr float most_cells = 1.0e9F;

inline vint corner_hash(const vint& x, const vint& y, const vint& z) {
    vint a = z * vint(std::int32_t(0x9e3779b9U));
    a = scramble(a + y);
    return scramble(a + x);
}

/// One of twelve gradients (four of them twice), times the way from its corner.
inline vfloat gradient(const vint& hash, const vfloat& x, const vfloat& y, const vfloat& z) {
    vint h = shift_right_logical(hash, 28);
    vfloat u = select(h < vint(8), x, y);
    vmask twice = h == vint(12);
    twice = twice | (h == vint(14));
    vfloat w = select(twice, x, z);
    vfloat v = select(h < vint(4), y, w);
    vint first = (h & vint(1)) << 31;
    vint second = (h & vint(2)) << 30;
    u = as_float(as_int(u) ^ first);
    v = as_float(as_int(v) ^ second);
    return u + v;
}

/// 6 t^5 - 15 t^4 + 10 t^3.
inline vfloat smoother(const vfloat& t) {
    vfloat inner = fma(t, fma(t, vfloat(6.0F), vfloat(-15.0F)), vfloat(10.0F));
    vfloat cube = t * t;
    cube = cube * t;
    return cube * inner;
}

inline vfloat mix(const vfloat& a, const vfloat& b, const vfloat& t) {
    return fma(t, b - a, a);
}

/// In [-1, 1], mean 0, one feature a cell.
[[gnu::noinline]] inline vfloat noise(const vvec& q) {
    vvec cell{floor(q.x), floor(q.y), floor(q.z)};
    vvec low = q - cell;
    vfloat one(1.0F);
    vvec high = low - vvec{one, one, one};
    vint x = to_int(cell.x);
    vint y = to_int(cell.y);
    vint z = to_int(cell.z);
    vfloat u = smoother(low.x);
    vfloat v = smoother(low.y);
    vfloat w = smoother(low.z);
    vfloat plane[2];
    for (int k = 0; k < 2; ++k) {
        vint at_z = z + vint(k);
        const vfloat& along_z = k == 0 ? low.z : high.z;
        vfloat row[2];
        for (int j = 0; j < 2; ++j) {
            vint at_y = y + vint(j);
            const vfloat& along_y = j == 0 ? low.y : high.y;
            vfloat a = gradient(corner_hash(x, at_y, at_z), low.x, along_y, along_z);
            vfloat b = gradient(corner_hash(x + vint(1), at_y, at_z), high.x, along_y, along_z);
            row[j] = mix(a, b, u);
        }
        plane[k] = mix(row[0], row[1], v);
    }
    return mix(plane[0], plane[1], w);
}

/// How much of something that repeats once a cell is left of it through a box as wide as that.
inline vfloat left_of_waves(const vfloat& width) {
    vfloat t = fma(width, vfloat(1.25F), vfloat(-0.25F));
    t = min(max(t, 0.0F), 1.0F);
    vfloat square = t * t;
    return fms(square, fma(t, vfloat(2.0F), vfloat(-3.0F)), vfloat(-1.0F));
}

/// Sum over octaves, each about twice as fine and `gain` times as high; Folded: of absolute values.
template <bool Folded>
inline vfloat sum_octaves(const vvec& q, const vfloat& width, sint octaves, sfloat gain) {
    constexpr float lacunarity = 1.99F; // not 2: zeros of octaves do not lie on each other
    constexpr float mean_folded = 0.2F; // of |noise|, about
    vfloat sum(0.0F);
    vfloat height(1.0F);
    vvec at = q;
    vfloat wide = width;
    for (sint k = 0; branch(k < octaves); ++k) {
        vfloat left = left_of_waves(wide);
        if (branch(!Folded & none(left > vfloat(0.0F))))
            return sum;
        vfloat value = noise(at);
        if constexpr (Folded) {
            value = abs(value) - vfloat(mean_folded);
            value = fma(left, value, vfloat(mean_folded));
        } else {
            value = value * left;
        }
        sum = fma(height, value, sum);
        height = height * vfloat(gain);
        at = at * vfloat(lacunarity);
        wide = wide * lacunarity;
    }
    return sum;
}

/// What lies within a box about x of waves that are 1 in part of each cell: `integral`, up to x.
template <class Integral> inline vfloat in_box(const vfloat& x, const vfloat& width, Integral integral) {
    vfloat least = max(abs(x) * 1.0e-6F, 1.0e-3F); // what differences are exact enough for
    vfloat wide = max(width, least);
    vfloat half = wide * 0.5F;
    vfloat above = integral(x + half);
    vfloat below = integral(x - half);
    return (above - below) / wide;
}

/// 1 in every other cell, -1 between.
inline vfloat checks(const vfloat& x, const vfloat& width) {
    vfloat odd = in_box(x, width, [](const vfloat& t) {
        vfloat pair = t * 0.5F;
        vfloat whole = floor(pair);
        vfloat rest = max(pair - whole - vfloat(0.5F), 0.0F);
        return fma(rest, vfloat(2.0F), whole);
    });
    return fma(odd, vfloat(-2.0F), vfloat(1.0F));
}

/// 1 in each cell but at its ends, as far as `margin`.
inline vfloat blocks(const vfloat& x, const vfloat& width, const vfloat& margin) {
    vfloat inner = fma(margin, vfloat(-2.0F), vfloat(1.0F));
    return in_box(x, width, [&](const vfloat& t) {
        vfloat whole = floor(t);
        vfloat rest = max(t - whole - margin, 0.0F);
        return fma(whole, inner, min(rest, inner));
    });
}

/// Stretcher bond, of bricks one cell long. As checks do, one lies about the origin: planes through that, as
/// floors often are, show no joint from within.
inline vfloat bricks(const vvec& q, const vvec& width, const vfloat& mortar) {
    constexpr float height = 0.35F;
    constexpr float depth = 0.5F;
    vfloat half = mortar * 0.5F;
    vfloat y = fma(q.y, vfloat(1.0F / height), vfloat(0.5F));
    vfloat row = floor(y) * 0.5F;
    vfloat shift = row - floor(row); // 0 or 1/2
    vfloat high = width.y * (1.0F / height);
    vfloat rows = blocks(y, high, half * (1.0F / height));
    vfloat along = shift + vfloat(0.5F);
    vfloat columns = blocks(q.x + along, width.x, half);
    vfloat z = fma(q.z, vfloat(1.0F / depth), along);
    vfloat deep = width.z * (1.0F / depth);
    vfloat layers = blocks(z, deep, half * (1.0F / depth));
    return rows * columns * layers;
}

/// 1/2 + sin(2 pi x) / 2.
inline vfloat waves(const vfloat& x, const vfloat& width) {
    vfloat turn = x - floor(x);
    vfloat height = left_of_waves(width) * 0.5F;
    return fma(height, sin(turn * 6.28318530717958647692F), vfloat(0.5F));
}

/// From 0 to 1, at q through boxes of these widths, all in cells.
inline vfloat pattern_value(pointer<TextureRecord> t, sint kind, const vvec& q, const vvec& width) {
    vfloat amount = load_broadcast(field(t, &TextureRecord::amount));
    if (branch(kind == texture_checker)) {
        vfloat middle(0.5F);
        vfloat product = checks(q.x + middle, width.x);
        product = product * checks(q.y + middle, width.y);
        product = product * checks(q.z + middle, width.z);
        return fma(product, vfloat(-0.5F), vfloat(0.5F));
    }
    if (branch(kind == texture_bricks))
        return bricks(q, width, amount);
    sint octaves = load(field(t, &TextureRecord::octaves));
    sfloat gain = load(field(t, &TextureRecord::gain));
    vfloat widest = max(width.x, width.y);
    widest = max(widest, width.z);
    if (branch(kind == texture_noise)) {
        vfloat sum = sum_octaves<false>(q, widest, octaves, gain);
        return min(max(fma(sum, vfloat(0.5F), vfloat(0.5F)), 0.0F), 1.0F);
    }
    if (branch(kind == texture_wood)) {
        vfloat radius = sqrt(fma(q.x, q.x, q.z * q.z));
        vvec slow = q * vfloat(0.25F); // rings are rounder than they are long
        vfloat bent = sum_octaves<false>(slow, widest * 0.25F, octaves, gain);
        return waves(fma(amount, bent, radius), widest);
    }
    vfloat sum = sum_octaves<true>(q, widest, octaves, gain);
    if (branch(kind == texture_marble))
        return waves(fma(amount, sum, q.x), widest);
    return min(sum, 1.0F);
}

/// Where patterns of texture coordinates lie along the third axis: within a brick, and off the zeros of
/// noise.
inline constexpr float pattern_plane = 0.25F;

/// Points in cells. What is no number, or too far away to have cells, is at 0.
inline vvec in_cells(const vvec& p, sfloat per_cell) {
    vvec q = p * vfloat(per_cell);
    vfloat limit(most_cells);
    vfloat zero(0.0F);
    q.x = select(abs(q.x) < limit, q.x, zero);
    q.y = select(abs(q.y) < limit, q.y, zero);
    q.z = select(abs(q.z) < limit, q.z, zero);
    return q;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
