// Textures at hits: trilinear in their pyramids (Williams, Pyramidal Parametrics, 1983), each ray by the area
// that it asked for there, so that what it sees neither depends on the level of detail's steps nor jumps with
// them. At hits and not at vertices, as flat patches have none inside.
#pragma once

#include "razor/kernels/pattern.h"
#include "razor/kernels/texels.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Linear colours of packed texels (razor/scene/textures/shared_exponent.h).
inline vvec unpack(const vint& texel) {
    vint exponent = shift_right_logical(texel, 27) + vint(127 - 24);
    vfloat scale = as_float(exponent << 23);
    vvec c;
    c.x = to_float(texel & vint(511));
    vint green = shift_right_logical(texel, 9) & vint(511);
    c.y = to_float(green);
    vint blue = shift_right_logical(texel, 18) & vint(511);
    c.z = to_float(blue);
    return c * scale;
}

/// A texture, and where hits lie on it, in [0, 1].
struct Sampled {
    pointer<TextureRecord> record;
    pointer<std::int32_t> texels;
    sint wrap_u, wrap_v;
    vpoint at;
};

inline vvec texel_at(const Sampled& t, const vint& first, const vint& tiles, const vint& x, const vint& y,
                     const vmask& m) {
    vint word = texel_word(first, tiles, x, y);
    return unpack(gather(t.texels, word, m));
}

/// Bilinear in one level a lane.
inline vvec bilinear(const Sampled& t, const vint& level, const vmask& m) {
    vint width = gather(field(t.record, &TextureRecord::width), level, m);
    vint height = gather(field(t.record, &TextureRecord::height), level, m);
    vint first = gather(field(t.record, &TextureRecord::first), level, m);
    vint tiles = (width + vint(3)) >> 2;
    Neighbours x = neighbours_of(t.at.u, width, t.wrap_u);
    Neighbours y = neighbours_of(vfloat(1.0F) - t.at.v, height, t.wrap_v); // rows run down
    vvec a = texel_at(t, first, tiles, x.low, y.low, m);
    vvec b = texel_at(t, first, tiles, x.high, y.low, m);
    vvec upper = madd(x.weight, b - a, a);
    a = texel_at(t, first, tiles, x.low, y.high, m);
    b = texel_at(t, first, tiles, x.high, y.high, m);
    vvec lower = madd(x.weight, b - a, a);
    return madd(y.weight, lower - upper, upper);
}

/// Opacity: that of its texels, in all three, instead of their colour.
template <bool Opacity>
[[gnu::noinline]] inline vvec sample_map(const Context& c, pointer<MapRecord> map, const Mapping& hit,
                                         const vmask& m) {
    vvec row_u = load_broadcast_vec(field(map, &MapRecord::row_u));
    vvec row_v = load_broadcast_vec(field(map, &MapRecord::row_v));
    Sampled t;
    sint number = load(field(map, &MapRecord::texture));
    t.record = load(field(c.frame, &FrameHeader::textures)) + number;
    sint kind = load(field(t.record, &TextureRecord::kind));
    if (branch(kind != texture_image)) {
        if constexpr (Opacity) {
            vfloat all(1.0F);
            return {all, all, all};
        } else {
            return sample_pattern(map, t.record, hit);
        }
    }
    t.texels = load(field(c.frame, &FrameHeader::texels));
    if constexpr (Opacity) {
        sint opacity = load(field(t.record, &TextureRecord::opacity));
        vfloat one(1.0F);
        if (branch(opacity == 0))
            return {one, one, one};
        t.texels = t.texels + opacity;
    }
    t.wrap_u = load(field(t.record, &TextureRecord::wrap_u));
    t.wrap_v = load(field(t.record, &TextureRecord::wrap_v));
    vfloat u = fma(row_u.x, hit.at.u, fma(row_u.y, hit.at.v, row_u.z));
    vfloat v = fma(row_v.x, hit.at.u, fma(row_v.y, hit.at.v, row_v.z));
    t.at.u = wrap_coordinate(u, t.wrap_u);
    t.at.v = wrap_coordinate(v, t.wrap_v);
    vfloat scale = abs(fms(row_u.x, row_v.y, row_u.y * row_v.x));
    vfloat size = load_broadcast(field(t.record, &TextureRecord::size));
    vfloat per_texel = scale * (size * size);
    vfloat texels = max(hit.footprint * per_texel, 1.0e-20F);
    vfloat level = log2(min(texels, 1.0e20F)) * 0.5F;
    sint levels = load(field(t.record, &TextureRecord::levels));
    vfloat last = vfloat(to_float(levels - 1));
    level = min(max(level, 0.0F), last);
    vfloat finer = floor(level);
    vint at = to_int(finer);
    vvec fine = bilinear(t, at, m);
    vfloat weight = level - finer;
    if (branch(none(m & (weight > vfloat(0.0F)))))
        return fine;
    vint next = at + vint(1);
    next = min(next, vint(levels - 1));
    vvec coarse = bilinear(t, next, m);
    return madd(weight, coarse - fine, fine);
}

/// By the number of each lane's map, -1: none, which is white; map after map.
template <bool Opacity = false>
inline vvec mapped_colour(const Context& c, const vint& map, const Mapping& hit, const vmask& m) {
    vfloat one(1.0F);
    vvec colour{one, one, one};
    for (vmask left = m & (map >= vint(0)); branch(any(left));) {
        sint lane = first(left);
        sint number = extract(map, lane);
        vmask here = left & (map == vint(number));
        left = left & !here;
        pointer<MapRecord> maps = load(field(c.frame, &FrameHeader::maps));
        colour = select(here, sample_map<Opacity>(c, maps + number, hit, here), colour);
    }
    return colour;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
