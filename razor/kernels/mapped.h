// Members of materials, and what their maps make of them.
#pragma once

#include "razor/kernels/texture.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// What textures make of points of surfaces: found at vertices of grids or at hits.
struct Shaded {
    vint bits; // of what is known, others are not: 1 << MaterialMap
    vvec albedo, emission;
    vfloat metallic, roughness;
    vvec normal; // unit, on the side of the surface's own

    vmask knows(MaterialMap which) const { return (bits & vint(1 << which)) > vint(0); }
};
inline Shaded nothing_shaded() {
    vfloat zero(0.0F);
    vvec none{zero, zero, zero};
    return {vint(0), none, none, zero, zero, none};
}

/// Members of the materials of a packet's hits, or of vertices.
struct Materials {
    pointer<MaterialRecord> first;
    vint record; // words from there
    vmask present;

    vfloat number(float MaterialRecord::*member) const {
        return gather(field(first, member), record, present);
    }
    vint whole(std::int32_t MaterialRecord::*member) const {
        return gather(field(first, member), record, present);
    }
    vvec colour(float (MaterialRecord::*member)[3]) const {
        return gather_vec(field(first, member), record, vint(1), present);
    }
    vint map(MaterialMap which, const vmask& m) const {
        return gather(field(first, &MaterialRecord::map) + which, record, m);
    }
    /// Of these lanes; 1 of others, and where there is no map.
    vvec mapped(const Context& c, MaterialMap which, const Mapping& at, const vmask& m) const {
        return mapped_colour(c, map(which, m), at, m);
    }
};
/// By their numbers.
inline Materials materials_of(const Context& c, const vint& material, const vmask& present) {
    pointer<MaterialRecord> first = load(field(c.frame, &FrameHeader::materials));
    return {first, material * vint(material_stride), present};
}

inline vvec times(const vvec& a, const vvec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Members as maps make them, but where that is known already.
inline vvec mapped_colour_of(const Context& c, const Materials& of, float (MaterialRecord::*member)[3],
                             MaterialMap which, const Mapping& at, const Shaded& known) {
    vmask there = known.knows(which);
    vvec found = of.mapped(c, which, at, of.present & !there);
    vvec colour = times(of.colour(member), found);
    vvec before = which == map_albedo ? known.albedo : known.emission;
    return select(there, before, colour);
}
inline vfloat mapped_metallic(const Context& c, const Materials& of, const Mapping& at, const Shaded& known) {
    vmask there = known.knows(map_metallic);
    vvec found = of.mapped(c, map_metallic, at, of.present & !there);
    return select(there, known.metallic, of.number(&MaterialRecord::metallic) * found.z);
}
inline vfloat mapped_roughness(const Context& c, const Materials& of, const Mapping& at,
                               const Shaded& known) {
    vmask there = known.knows(map_roughness);
    vvec found = of.mapped(c, map_roughness, at, of.present & !there);
    return select(there, known.roughness, of.number(&MaterialRecord::roughness) * found.y);
}

/// Normals bent by normal maps, which hold what they are against tangents along u and v and the normal. `m`:
/// where there is one. `own`: unit, as the surface has it.
inline vvec bend_normal(const Context& c, const Materials& of, const vint& map, const Mapping& at,
                        const vvec& own, const vmask& m) {
    vvec colour = mapped_colour(c, map, at, m);
    vfloat scale = of.number(&MaterialRecord::normal_scale);
    vfloat x = fma(colour.x, vfloat(2.0F), vfloat(-1.0F)) * scale;
    vfloat y = fma(colour.y, vfloat(2.0F), vfloat(-1.0F)) * scale;
    vfloat z = fma(colour.z, vfloat(2.0F), vfloat(-1.0F));
    vvec along = at.along_u - own * dot(own, at.along_u);
    vfloat zero(0.0F);
    vvec tangent = normalise(along, {zero, zero, zero});
    vvec bitangent = cross(own, tangent);
    vfloat turned = dot(bitangent, at.along_v);
    bitangent = bitangent * select(turned < zero, vfloat(-1.0F), vfloat(1.0F));
    vvec bent = madd(y, bitangent, tangent * x);
    return madd(z, own, bent);
}

/// So many of these points have textures that are to be evaluated.
inline void count_evaluations(const Context& c, const Materials& of, const Shaded& known) {
    vint maps = of.whole(&MaterialRecord::map_bits);
    vmask textured = of.present & (maps > vint(0));
    tally(c.counters->textured_hits, count(textured));
    // What is known of one map is known of all.
    tally(c.counters->shading_evaluations, count(textured & (known.bits == vint(0))));
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
