// Where points of a surface lie on textures, and how finely those are seen there.
#pragma once

#include "isa/math.h"
#include "razor/kernels/packet.h"
#include "razor/kernels/sampling.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

inline vvec gather_vec(pointer<float> words, const vint& at, const vint& stride, const vmask& m) {
    vvec v;
    v.x = gather(words, at, m);
    vint next = at + stride;
    v.y = gather(words, next, m);
    next = next + stride;
    v.z = gather(words, next, m);
    return v;
}

inline vvec blend(const vvec& a, const vvec& b, const vvec& c, const Hits& h) {
    vfloat w = vfloat(1.0F) - h.u;
    w = w - h.v;
    return madd(h.v, c, madd(h.u, b, a * w));
}

/// The corners of the triangles hit, and their vertices' normals interpolated (zero where they have none).
struct Corners {
    vvec a, b, c;
    vvec at_a, at_b, at_c, normal; // normals: of the corners, and between them
    vfloat sway, sway_above;       // of the block's finest vertices; with those of the next coarser level
    vmask has_chords;              // the block is not flat, or is shaded at vertices: see chords.h
    vvec chord_normal;
    vfloat chord_slope, chord_most;
    vpoint map_a, map_b, map_c;  // texture coordinates, where they are asked for and there are any
    vmask has_rest;              // where textures are asked for, and the mesh changes its shape:
    vvec rest_a, rest_b, rest_c; // the corners while it is at rest, in the mesh's coordinates
};
/// The target edge length that each ray asks for `way` from its field's origin (see target_at()).
inline vfloat asked_at(const Rays& r, const vvec& way) {
    vfloat distance = sqrt(dot(way, way)) - r.radius;
    distance = max(distance, 0.0F);
    vfloat along = dot(r.slope, way) + r.base;
    vfloat target = fma(r.growth, distance, abs(along));
    return max(target, vfloat(least_target));
}

/// Where a hit lies on its texture, and how.
struct Mapping {
    vpoint at;
    vfloat footprint; // the area, in texture coordinates, that the ray asked for
    vfloat across;    // of texture coordinates along two sides of the triangle: their parallelogram
    vvec along_u;     // how points move with texture coordinates, times `across`
    vvec along_v;
    vfloat asked;  // the area that the ray asked for on the surface
    vint instance; // word of its record
    // Where some texture is a pattern of objects:
    vvec solid;        // the point, in its object
    vfloat solid_area; // `asked`, in the object's units
    vvec solid_spread; // how far a square on the surface reaches along the object's axes, by its side
    // Where some mesh with such a texture changes its shape:
    vmask has_rest;
    vvec rest_u, rest_v; // two sides of the triangle at rest ...
    vvec dual_u, dual_v; // ... and by what a direction on the surface has how much of each
};

/// Points of instances, or with `rest` 0 directions, in their objects.
inline vvec to_object(pointer<SolidRecord> solids, const vint& record, const vvec& p, const vfloat& rest,
                      const vmask& m) {
    pointer<float> words = as<float>(solids);
    vvec out;
    vfloat* const to[3] = {&out.x, &out.y, &out.z};
    for (int k = 0; k < 3; ++k) {
        vfloat shift = gather(words + (4 * k + 3), record, m);
        vfloat sum = shift * rest;
        sum = fma(gather(words + 4 * k, record, m), p.x, sum);
        sum = fma(gather(words + (4 * k + 1), record, m), p.y, sum);
        *to[k] = fma(gather(words + (4 * k + 2), record, m), p.z, sum);
    }
    return out;
}
/// Word of an instance's SolidRecord.
inline vint solid_of(const vint& instance) {
    static_assert(sizeof(InstanceRecord) == 2 * sizeof(SolidRecord));
    return instance >> 1;
}

/// How far a square of side 1 and that normal reaches along each axis.
inline vvec spread_of(const vvec& normal) {
    vfloat one(1.0F);
    vvec spread;
    spread.x = sqrt(max(one - normal.x * normal.x, 0.0F));
    spread.y = sqrt(max(one - normal.y * normal.y, 0.0F));
    spread.z = sqrt(max(one - normal.z * normal.z, 0.0F));
    return spread;
}

/// Likewise of hits on meshes that change their shape: where they are at rest, so that patterns stay on the
/// surface (known as reference positions, or Pref).
inline void map_rest(const Corners& k, const Hits& h, const vvec& edge1, const vvec& edge2, Mapping& map) {
    map.has_rest = k.has_rest;
    map.rest_u = k.rest_b - k.rest_a;
    map.rest_v = k.rest_c - k.rest_a;
    vvec area = cross(edge1, edge2);
    vfloat square = max(dot(area, area), 1.0e-36F);
    vfloat per_square = reciprocal(square);
    map.dual_u = cross(edge2, area) * per_square;
    map.dual_v = cross(area, edge1) * per_square;
    vvec rest_area = cross(map.rest_u, map.rest_v);
    vfloat growth = sqrt(dot(rest_area, rest_area) * per_square); // of areas
    map.solid = select(k.has_rest, blend(k.rest_a, k.rest_b, k.rest_c, h), map.solid);
    map.solid_area = select(k.has_rest, map.asked * growth, map.solid_area);
    vfloat zero(0.0F);
    vvec spread = spread_of(normalise(rest_area, {zero, zero, zero}));
    map.solid_spread = select(k.has_rest, spread, map.solid_spread);
}

/// Where points lie in their objects, if some texture is a pattern of those. `p`, and two sides of the
/// triangles `k` that they lie on: instances' coordinates.
inline void map_solid(const Context& c, const vint& instance, const Corners& k, const Hits& h, const vvec& p,
                      const vvec& edge1, const vvec& edge2, const vmask& m, Mapping& map) {
    map.instance = instance;
    pointer<SolidRecord> solids = load(field(c.frame, &FrameHeader::solids));
    if (branch(is_null(solids)))
        return;
    vint record = solid_of(instance);
    map.solid = to_object(solids, record, p, vfloat(1.0F), m);
    vfloat shrink = gather(field(solids, &SolidRecord::shrink), record, m);
    map.solid_area = map.asked * (shrink * shrink);
    vfloat zero(0.0F);
    vvec along1 = to_object(solids, record, edge1, zero, m);
    vvec along2 = to_object(solids, record, edge2, zero, m);
    map.solid_spread = spread_of(normalise(cross(along1, along2), {zero, zero, zero}));
    pointer<float> rest = load(field(c.frame, &FrameHeader::rest_points));
    if (branch(!is_null(rest)))
        map_rest(k, h, edge1, edge2, map);
}

inline Mapping map_hit(const Corners& k, const Hits& h, const vvec& edge1, const vvec& edge2,
                       const vvec& area, const vfloat& target, const vfloat& cosine) {
    Mapping map;
    vfloat w = vfloat(1.0F) - h.u;
    w = w - h.v;
    map.at.u = fma(h.v, k.map_c.u, fma(h.u, k.map_b.u, k.map_a.u * w));
    map.at.v = fma(h.v, k.map_c.v, fma(h.u, k.map_b.v, k.map_a.v * w));
    vfloat u1 = k.map_b.u - k.map_a.u;
    vfloat v1 = k.map_b.v - k.map_a.v;
    vfloat u2 = k.map_c.u - k.map_a.u;
    vfloat v2 = k.map_c.v - k.map_a.v;
    vfloat across = fms(u1, v2, u2 * v1);
    vfloat surface = sqrt(dot(area, area));
    surface = max(surface, 1.0e-36F);
    // Across the ray it asks for a square; on the surface that is as much longer as it is inclined.
    vfloat inclined = max(cosine, 0.05F);
    map.asked = (target * target) / inclined;
    vfloat share = map.asked / surface;
    map.across = abs(across);
    map.footprint = map.across * share;
    vfloat sign = select(across < vfloat(0.0F), vfloat(-1.0F), vfloat(1.0F));
    vvec tangent = edge2 * v1;
    map.along_u = (edge1 * v2 - tangent) * sign;
    tangent = edge1 * u2;
    map.along_v = (edge2 * u1 - tangent) * sign;
    return map;
}

/// What a texture is filtered for: what the ray asked for; where one level serves all, what a ray of the
/// camera asks for as far away.
inline vfloat filtered_target(const Context& c, const vfloat& target, const vvec& way) {
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    if (branch(fixed > 0.0F)) {
        vfloat base = load_broadcast(field(c.frame, &FrameHeader::camera_base));
        vfloat growth = load_broadcast(field(c.frame, &FrameHeader::camera_growth));
        vfloat distance = sqrt(dot(way, way));
        return fma(growth, distance, abs(base));
    }
    return target;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
