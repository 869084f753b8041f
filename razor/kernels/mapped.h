// Members of materials, and what their maps make of them.
#pragma once

#include "razor/frame/sheen_albedo.h"
#include "razor/kernels/basis.h"
#include "razor/kernels/texture.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// What textures make of points of surfaces: found at vertices of grids or at hits.
struct Shaded {
    vint bits; // of what is known, others are not: 1 << MaterialMap
    vvec albedo, emission;
    vfloat metallic, roughness;
    vvec normal; // unit, on the side of the surface's own
    vvec sheen;
    vfloat sheen_roughness;
    /// Of all this, where vertices lie too far apart for what a ray asks for: the rest is found at the hit.
    vfloat share;

    vmask knows(MaterialMap which) const { return (bits & vint(map_bit(which))) > vint(0); }
    vmask whole() const { return share >= vfloat(1.0F); }
    vvec mixed(MaterialMap which, const vvec& at_vertices, const vvec& at_hit) const {
        vvec both = madd(share, at_vertices - at_hit, at_hit);
        both = select(whole(), at_vertices, both);
        return select(knows(which), both, at_hit);
    }
    vfloat mixed(MaterialMap which, const vfloat& at_vertices, const vfloat& at_hit) const {
        vfloat both = fma(share, at_vertices - at_hit, at_hit);
        both = select(whole(), at_vertices, both);
        return select(knows(which), both, at_hit);
    }
    /// Where maps are to be evaluated.
    vmask open(MaterialMap which) const {
        vmask known = knows(which);
        return !(known & whole());
    }
};
inline Shaded nothing_shaded() {
    vfloat zero(0.0F);
    vvec none{zero, zero, zero};
    return {vint(0), none, none, zero, zero, none, none, zero, zero};
}

/// Members of records of a packet's hits, or of vertices.
template <class Record> struct Members {
    pointer<Record> first;
    vint record; // words from there
    vmask present;

    vfloat number(float Record::*member) const { return gather(field(first, member), record, present); }
    vint whole(std::int32_t Record::*member) const { return gather(field(first, member), record, present); }
    vvec colour(float (Record::*member)[3]) const {
        return gather_vec(field(first, member), record, vint(1), present);
    }
};
/// Of their materials.
struct Materials : Members<MaterialRecord> {
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
    return {{first, material * vint(material_stride), present}};
}

/// Of the sheen that these have.
using Sheens = Members<SheenRecord>;
inline Sheens sheens_of(const Context& c, const Materials& of) {
    pointer<SheenRecord> first = load(field(c.frame, &FrameHeader::sheen_records));
    return {first, of.whole(&MaterialRecord::sheen), of.present};
}

inline vvec times(const vvec& a, const vvec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Members as maps make them, but where that is known already.
inline vvec mapped_colour_of(const Context& c, const Materials& of, float (MaterialRecord::*member)[3],
                             MaterialMap which, const Mapping& at, const Shaded& known) {
    vvec found = of.mapped(c, which, at, of.present & known.open(which));
    vvec colour = times(of.colour(member), found);
    return known.mixed(which, which == map_albedo ? known.albedo : known.emission, colour);
}
inline vfloat mapped_metallic(const Context& c, const Materials& of, const Mapping& at, const Shaded& known) {
    vvec found = of.mapped(c, map_metallic, at, of.present & known.open(map_metallic));
    vfloat metallic = of.number(&MaterialRecord::metallic) * found.z;
    return known.mixed(map_metallic, known.metallic, metallic);
}
inline vfloat mapped_roughness(const Context& c, const Materials& of, const Mapping& at,
                               const Shaded& known) {
    vvec found = of.mapped(c, map_roughness, at, of.present & known.open(map_roughness));
    vfloat roughness = of.number(&MaterialRecord::roughness) * found.y;
    return known.mixed(map_roughness, known.roughness, roughness);
}

/// Likewise of sheen, within what its model is for, whatever a texture holds.
[[gnu::noinline]] inline vvec mapped_sheen(const Context& c, const Sheens& of, const Mapping& at,
                                           const Shaded& known) {
    vint map = gather(field(of.first, &SheenRecord::map), of.record, of.present);
    vvec found = mapped_colour(c, map, at, of.present & known.open(map_sheen));
    vvec colour = times(of.colour(&SheenRecord::colour), found);
    colour.x = min(colour.x, 1.0F);
    colour.y = min(colour.y, 1.0F);
    colour.z = min(colour.z, 1.0F);
    return known.mixed(map_sheen, known.sheen, colour);
}
[[gnu::noinline]] inline vfloat mapped_sheen_roughness(const Context& c, const Sheens& of, const Mapping& at,
                                                       const Shaded& known) {
    vint map = gather(field(of.first, &SheenRecord::map) + 1, of.record, of.present);
    vvec found = mapped_colour(c, map, at, of.present & known.open(map_sheen_roughness));
    vfloat roughness = of.number(&SheenRecord::roughness) * found.y;
    roughness = min(max(roughness, least_sheen_roughness), 1.0F);
    return known.mixed(map_sheen_roughness, known.sheen_roughness, roughness);
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

/// A texture as heights: its luminance (IEC 61966-2-1).
inline vfloat height_at(const Context& c, const vint& map, const Mapping& at, const vmask& m) {
    vvec colour = mapped_colour(c, map, at, m);
    vfloat sum = colour.x * 0.2126F;
    sum = fma(colour.y, vfloat(0.7152F), sum);
    return fma(colour.z, vfloat(0.0722F), sum);
}

/// How much higher a bump map is a step further along a unit direction of the surface, by the step.
inline vfloat slope_along(const Context& c, const vint& map, const Mapping& at, const vvec& way,
                          const vfloat& step, const vpoint& texcoords, const vfloat& height, const vmask& m) {
    Mapping next = at;
    next.at.u = next.at.u + texcoords.u;
    next.at.v = next.at.v + texcoords.v;
    pointer<SolidRecord> solids = load(field(c.frame, &FrameHeader::solids));
    if (branch(!is_null(solids))) {
        vfloat zero(0.0F);
        vint record = solid_of(at.instance);
        vvec moved = to_object(solids, record, way * step, zero, m);
        pointer<float> rest = load(field(c.frame, &FrameHeader::rest_points));
        if (branch(!is_null(rest))) {
            vfloat along_u = dot(way, at.dual_u) * step;
            vfloat along_v = dot(way, at.dual_v) * step;
            moved = select(at.has_rest, madd(along_v, at.rest_v, at.rest_u * along_u), moved);
        }
        next.solid = at.solid + moved;
    }
    vfloat rise = height_at(c, map, next, m) - height;
    return rise / step;
}

/// Normals bent by bump maps (Blinn, Simulation of Wrinkled Surfaces, 1978), by differences over half of what
/// the ray asked for. `m`: where there is one. `own`: unit, as the surface has it.
inline vvec bump_normal(const Context& c, const Materials& of, const vint& map, const Mapping& at,
                        const vvec& own, const vmask& m) {
    vfloat zero(0.0F);
    vfloat step = max(sqrt(at.asked) * 0.5F, 1.0e-18F);
    // Along texture coordinates, or, where there are none, any two ways.
    Basis any = basis_about(own);
    vvec along = at.along_u - own * dot(own, at.along_u);
    vvec first = normalise(along, any.x);
    vvec second = normalise(at.along_v - own * dot(own, at.along_v), any.y);
    vfloat by_u = sqrt(dot(at.along_u, at.along_u));
    vfloat by_v = sqrt(dot(at.along_v, at.along_v));
    vmask has = by_u > zero;
    has = has & (by_v > zero);
    first = select(has, first, any.x);
    second = select(has, second, any.y);
    vfloat texcoords = step * at.across;
    vpoint along_u{select(has, texcoords / max(by_u, 1.0e-30F), zero), zero};
    vpoint along_v{zero, select(has, texcoords / max(by_v, 1.0e-30F), zero)};
    // In units of the instance.
    pointer<float> instances = as<float>(c.instances);
    constexpr int edge_word = offsetof(InstanceRecord, edge_length) / 4;
    constexpr int mesh_word = offsetof(InstanceRecord, mesh_edge_length) / 4;
    vfloat scale = gather(instances + edge_word, at.instance, m);
    scale = scale / gather(instances + mesh_word, at.instance, m);
    scale = scale * of.number(&MaterialRecord::bump);
    vfloat height = height_at(c, map, at, m);
    vfloat slope_u = slope_along(c, map, at, first, step, along_u, height, m) * scale;
    vfloat slope_v = slope_along(c, map, at, second, step, along_v, height, m) * scale;
    vvec along_first = madd(slope_u, own, first);
    vvec along_second = madd(slope_v, own, second);
    vvec bent = cross(along_first, along_second);
    vfloat turned = dot(cross(first, second), own);
    bent = bent * select(turned < zero, vfloat(-1.0F), vfloat(1.0F));
    return normalise(bent, own);
}

/// Normals as the normal or bump maps of these materials bend them; both: the bump's on what the other makes.
/// `own`: unit, as the surface has it.
inline vvec mapped_normal(const Context& c, const Materials& of, const Mapping& at, const vvec& own,
                          const vmask& m) {
    vvec bent = own;
    vint map = of.map(map_normal, m);
    vmask has = m & (map >= vint(0));
    if (branch(any(has)))
        bent = select(has, normalise(bend_normal(c, of, map, at, own, has), own), bent);
    map = of.map(map_bump, m);
    has = m & (map >= vint(0));
    if (branch(any(has)))
        bent = select(has, bump_normal(c, of, map, at, bent, has), bent);
    return bent;
}

/// So many of these points have textures that are to be evaluated.
inline void count_evaluations(const Context& c, const Materials& of, const Shaded& known) {
    vint maps = of.whole(&MaterialRecord::map_bits);
    vmask textured = of.present & (maps > vint(0));
    tally(c.counters->textured_hits, count(textured));
    vmask open = known.bits == vint(0); // what is known of one map is known of all
    open = open | !known.whole();
    tally(c.counters->shading_evaluations, count(textured & open));
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
