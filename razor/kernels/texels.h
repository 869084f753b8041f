// Where texture coordinates fall among texels: what shading and tessellation share.
#pragma once

#include "razor/kernels/sampling.h"

namespace razor::ISA_TARGET {

/// Into [0, 1]; what is no number becomes 0.
inline vfloat wrap_coordinate(const vfloat& u, sint wrap) {
    vfloat t = u;
    if (branch(wrap == wrap_repeat)) {
        t = u - floor(u);
    } else if (branch(wrap == wrap_mirror)) {
        vfloat half = u * 0.5F;
        half = half - floor(half);
        vfloat folded = fma(half, vfloat(2.0F), vfloat(-1.0F));
        t = vfloat(1.0F) - abs(folded);
    }
    return min(max(t, 0.0F), 1.0F);
}

/// The two texels beside a coordinate, and the weight of the second.
struct Neighbours {
    vint low, high;
    vfloat weight;
};
inline Neighbours neighbours_of(const vfloat& u, const vint& size, sint wrap) {
    vfloat x = fma(u, to_float(size), vfloat(-0.5F));
    vfloat below = floor(x);
    Neighbours n;
    n.weight = x - below;
    n.low = to_int(below);
    n.high = n.low + vint(1);
    vint last = size - vint(1);
    vmask round = vmask(wrap == wrap_repeat);
    vint low = select(round, last, vint(0));
    n.low = select(n.low < vint(0), low, n.low);
    vint high = select(round, vint(0), last);
    n.high = select(n.high > last, high, n.high);
    return n;
}

/// Words, from the texture's first, of texels of a level that begins at `first` and has so many tiles a row.
inline vint texel_word(const vint& first, const vint& tiles, const vint& x, const vint& y) {
    vint tile = (y >> 2) * tiles;
    tile = tile + (x >> 2);
    vint within = (y & vint(3)) << 2;
    within = within + (x & vint(3));
    vint word = (tile << 4) + within;
    return word + first;
}

} // namespace razor::ISA_TARGET
