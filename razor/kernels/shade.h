// Hits to surface points, as they are lit.
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/kernels/differentials.h"
#include "razor/kernels/hit_triangles.h"
#include "razor/kernels/mapped.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// What a hit is shaded with, one lane a camera ray; world directions, scene coordinates.
struct Surface {
    vmask hit;
    vvec position;  // moved off the surface, against self-intersection
    vvec geometric; // unit normal of the triangle, towards the viewer
    vvec shading;   // unit, interpolated, towards the viewer
    vvec albedo;
    vfloat target, growth; // the edge length that the camera ray asked for here, and how fast it changes
    vint pixel, sample;    // number of the pixel and of its camera sample, for sampling
    vmask fine;            // the block that was hit is of several cells
    // That block, and which rays do not meet it again: those whose direction is steeper (chords.h).
    vint block;
    vvec chord_normal; // towards the viewer
    vfloat chord_slope;
    vfloat chord_growth; // of what they ask for, at most
};

/// Bound on the error of a point p computed as a blend of `a`, `b`, `c` and moved by `origin`, and of the
/// place where a ray that leaves it meets their plane (as in pbrt, 6.8). In units of u of the largest
/// coordinate M of the corners or of the origin:
///   p: its weights add up to 1 but for 2 roundings: 2; product and multiply-adds: 3, on sse4 5; the origin
///   added, to 2 M at most: 2; moved off the surface: 2; the triangle as the ray sees it: the ray's origin
///   moved back: 1; corners less that, 2 M at most: 2; both sheared by up to 2, sqrt(5) (1 + 2) = 6.8, and
///   rounded then, up to sqrt(5) 2 M: 4.5.
/// In all 22.3 of 24.
inline vfloat position_error(const vvec& a, const vvec& b, const vvec& c, const vvec& origin) {
    vfloat of_a = largest(abs(a));
    vfloat of_b = largest(abs(b));
    vfloat of_c = largest(abs(c));
    vfloat shift = largest(abs(origin));
    vfloat size = max(of_a, of_b);
    size = max(size, of_c);
    return max(size, shift) * (24.0F * unit_roundoff);
}

/// Adds how far a point lies behind the plane through a corner of its triangle, times the corner's weight.
/// `side`: 1, or -1 where the normals point away from the viewer.
inline void lift_to_plane(const vvec& p, const vvec& corner, const vvec& normal, const vfloat& side,
                          const vfloat& weight, vvec& lift) {
    vfloat behind = -(dot(p - corner, normal) * side);
    behind = max(behind, 0.0F) * weight;
    lift = madd(behind * side, normal, lift);
}

/// From a point of a facet to the curved surface that its corners' normals suggest, where that bulges towards
/// the viewer: rays that leave from there are not stopped by the facets beside it while the shading normal
/// still faces the light (Hanika, "Hacking the shadow terminator", Ray Tracing Gems II, 2021).
inline vvec lift_of(const Corners& k, const Hits& h, const vvec& p, const vfloat& side) {
    vfloat zero(0.0F);
    vvec lift{zero, zero, zero};
    vfloat w = vfloat(1.0F) - h.u;
    w = w - h.v;
    lift_to_plane(p, k.a, k.at_a, side, w, lift);
    lift_to_plane(p, k.b, k.at_b, side, h.u, lift);
    lift_to_plane(p, k.c, k.at_c, side, h.v, lift);
    return lift;
}

inline vfloat turn_along(const vvec& from, const vvec& to, const vvec& normal, const vvec& other) {
    vvec along = to - from;
    vvec turn = other - normal;
    vfloat square = max(dot(along, along), 1.0e-30F);
    return dot(along, turn) / square;
}

/// How fast the shading normal turns along the triangle, 1 / length, the mean of its sides: positive where
/// the surface bulges towards the viewer.
inline vfloat curvature_of(const Corners& k, const vfloat& side) {
    vfloat sum = turn_along(k.a, k.b, k.at_a, k.at_b);
    sum = sum + turn_along(k.b, k.c, k.at_b, k.at_c);
    sum = sum + turn_along(k.c, k.a, k.at_c, k.at_a);
    return (sum * side) * (1.0F / 3.0F);
}

/// What shading other than that of plain matte surfaces needs to know of a hit besides.
struct Beyond {
    Mapping map;
    vfloat side;   // 1, or -1 where the surface's own normal, outwards, is not the one that faces the viewer
    vvec toward;   // unit, to the viewer
    vmask inside;  // the viewer is behind the surface
    vvec before;   // moved off the surface for bounces, back along the ray
    vvec position; // moved off the surface to the side that the viewer is not on
    vfloat curvature; // see curvature_of()
    vint material;    // its number
    Shaded known;     // what textures make of it, where that was found at vertices
};

/// Of the faces hit; `record`: word of their instances.
inline vint face_material(const Context& c, const Hits& h, const vint& record, const vmask& m) {
    pointer<std::int32_t> instances = as<std::int32_t>(c.instances);
    constexpr int first_patch_word = offsetof(InstanceRecord, first_patch) / 4;
    constexpr int first_record_word = offsetof(InstanceRecord, first_record) / 4;
    vint first_patch = gather(instances + first_patch_word, record, m);
    vint first_record = gather(instances + first_record_word, record, m);
    vint patch = (h.patch - first_patch) + first_record;
    constexpr int face_word = offsetof(PatchRecord, face) / 4;
    constexpr int patch_words = sizeof(PatchRecord) / 4;
    vint word = patch * vint(patch_words);
    vint face = gather(as<std::int32_t>(c.patches) + face_word, word, m);
    pointer<std::int32_t> materials = load(field(c.frame, &FrameHeader::face_materials));
    return gather(materials, face, m);
}

/// What rays ask for as a share of the length at which the finest vertices of their blocks are gone
/// (gone_from()): a half, where those of the next finer level are, to 1.
inline vfloat part_gone(const Context& c, const vint& block, const vfloat& target, const vmask& m) {
    constexpr int absolute_word = offsetof(BlockHeader, absolute) / 4;
    vint absolute = gather(as<std::int32_t>(c.grids) + absolute_word, block, m);
    vfloat gone = as_float((absolute + vint(128)) << 23);
    return min(max(target / gone, 0.5F), 1.0F);
}

/// Of what is shaded at vertices and what at hits: all of the first where rays ask for edges as long as the
/// block's or longer, as they do of levels that are chosen for them; where a block is as fine as its mesh
/// gets, or one level serves all, less of it the finer they ask.
inline vfloat share_of_vertices(const Context& c, const vint& block, const vfloat& target, const vmask& m) {
    constexpr int absolute_word = offsetof(BlockHeader, absolute) / 4;
    vint absolute = gather(as<std::int32_t>(c.grids) + absolute_word, block, m);
    vint exponent = absolute + vint(127);
    vfloat edge = as_float(exponent << 23);
    constexpr float per_edge = 1 / (shaded_edge - least_shaded_edge);
    vfloat asked = target / edge;
    vfloat share = fma(asked, vfloat(per_edge), vfloat(-least_shaded_edge * per_edge));
    return min(max(share, 0.0F), 1.0F);
}

/// Rays that leave a hit ask for edges longer than the ray did that found it by this factor at most, and as
/// long within so many of them (leave_surface()).
inline constexpr float shared_ratio = 1.05F;
inline constexpr float leaving_reach = 8.0F;

/// Which rays leave the blocks that were hit for good; `facet`: normals of the triangles hit, towards the
/// viewer; `p`: the hits, in their instances' coordinates.
inline void find_steep(const Context& c, const Corners& k, const vvec& facet, const vvec& p,
                       const vint& block, Surface& s) {
    vmask away = dot(k.chord_normal, facet) < vfloat(0.0F);
    vvec normal = select(away, k.chord_normal * vfloat(-1.0F), k.chord_normal);
    s.chord_normal = select(k.has_chords, normal, facet); // blocks without are flat
    s.block = block;
    // How fast edges that they ask for may grow without being too long anywhere in the block.
    pointer<float> headers = as<float>(c.grids);
    constexpr int low_word = offsetof(BlockHeader, box_low) / 4;
    constexpr int high_word = offsetof(BlockHeader, box_high) / 4;
    vint word = block << 4;
    vvec before = p - gather_vec(headers + low_word, word, vint(1), s.hit);
    vvec after = gather_vec(headers + high_word, word, vint(1), s.hit) - p;
    vvec far{max(before.x, after.x), max(before.y, after.y), max(before.z, after.z)};
    sint one_field = load(field(c.frame, &FrameHeader::one_field));
    vfloat alike = s.target * leaving_reach;
    alike = select(vmask(one_field != 0), vfloat(0.0F), alike);
    vfloat reach = max(sqrt(dot(far, far)) - alike, least_target);
    vfloat room = fnma(s.target, vfloat(shared_ratio * few_up), k.chord_most * (1.0F / level_rounding));
    s.chord_growth = room / reach;
    vmask known = room >= vfloat(0.0F);
    if (branch(one_field != 0)) {
        known = known & (s.growth <= s.chord_growth);
        s.chord_growth = vfloat(infinite); // they ask for what the camera does
    }
    s.chord_slope = select(known, k.chord_slope, vfloat(never_leaves));
}

/// `beyond` is filled in for looks that need it. `on_grids`: the rays are the camera's, and find what
/// textures make of surfaces at the vertices of their grids.
template <Look L>
[[gnu::noinline]] inline Surface find_surface(const Context& c, const Rays& r, const Hits& h, sbool on_grids,
                                              Beyond& beyond) {
    phase_scope phase(phase_shade);
    Surface s;
    s.hit = h.patch >= vint(0);
    constexpr bool mapped = L == look_mapped || L == look_glossy_mapped;
    constexpr bool glossy = L == look_glossy || L == look_glossy_mapped;
    Corners k = find_triangles<mapped, glossy>(c, r, h, s.hit, on_grids, beyond.known);
    vvec toward = r.direction * vfloat(-1.0F);
    vvec edge1 = k.b - k.a;
    vvec edge2 = k.c - k.a;
    vvec area = cross(edge1, edge2);
    vvec n = normalise(area, toward);
    s.shading = normalise(k.normal, n);
    vvec way = madd(h.t, r.direction, r.origin - r.field_origin);
    s.target = asked_at(r, way);
    s.growth = r.growth + sqrt(dot(r.slope, r.slope));

    // Both normals face the viewer: surfaces are two-sided.
    vfloat zero(0.0F);
    vmask away = dot(n, toward) < zero;
    vvec flipped = n * vfloat(-1.0F);
    s.geometric = select(away, flipped, n);
    vmask opposed = dot(s.shading, s.geometric) < zero;
    flipped = s.shading * vfloat(-1.0F);
    s.shading = select(opposed, flipped, s.shading);

    constexpr int instance_word = offsetof(BlockHeader, instance) / 4;
    constexpr int instance_words = sizeof(InstanceRecord) / 4;
    vint block = h.block << 4;
    vint instance = gather(as<std::int32_t>(c.grids) + instance_word, block, s.hit);
    constexpr int cells_word = offsetof(BlockHeader, cells_at) / 4;
    vint cells = gather(as<std::int32_t>(c.grids) + cells_word, block, s.hit);
    s.fine = cells != vint(0);
    vint record = instance * vint(instance_words);
    vvec origin = gather_vec(field(c.instances, &InstanceRecord::origin), record, vint(1), s.hit);
    if constexpr (L == look_matte)
        s.albedo = gather_vec(field(c.instances, &InstanceRecord::albedo), record, vint(1), s.hit);
    vvec p = blend(k.a, k.b, k.c, h);
    find_steep(c, k, s.geometric, p, h.block, s);
    vfloat rounding = position_error(k.a, k.b, k.c, origin);
    vmask morphs = vmask(load(field(c.frame, &FrameHeader::leaving_morphs)) != 0);
    vfloat error = select(morphs, k.sway + rounding, rounding);
    vfloat side = select(opposed, vfloat(-1.0F), vfloat(1.0F));
    if constexpr (glossy) {
        beyond.toward = toward;
        beyond.position = madd(-error, s.geometric, p);
        beyond.position = beyond.position + origin;
        beyond.curvature = curvature_of(k, side);
    }
    if constexpr (L != look_matte) {
        constexpr int material_word = offsetof(InstanceRecord, material) / 4;
        beyond.material = gather(as<std::int32_t>(c.instances) + material_word, record, s.hit);
        // Of what a mirror turned over, counter-clockwise is clockwise.
        constexpr int moved_word = offsetof(InstanceRecord, moved) / 4;
        vint moved = gather(as<std::int32_t>(c.instances) + moved_word, record, s.hit);
        vmask turned = moved < vint(0);
        beyond.inside = away & !turned;
        beyond.inside = beyond.inside | (turned & !away);
        beyond.side = select(turned, -side, side);
    }
    if constexpr (mapped) {
        vfloat target = filtered_target(c, s.target, way);
        beyond.map = map_hit(k, h, edge1, edge2, area, target, dot(s.geometric, toward));
        vmask of_face = s.hit & (beyond.material < vint(0));
        if (branch(any(of_face)))
            beyond.material = select(of_face, face_material(c, h, record, of_face), beyond.material);
        beyond.known.normal = beyond.known.normal * side;
        beyond.known.share = share_of_vertices(c, block, target, s.hit);
        map_solid(c, record, k, h, p, edge1, edge2, s.hit, beyond.map);
    }
    p = p + lift_of(k, h, p, side);
    p = p + origin;
    // Rays to lights leave as far off the surface as the finest vertices of its block can move: what they see
    // there is no further from what was hit.
    s.position = madd(error, s.geometric, p);
    if constexpr (glossy) {
        // Bounces, behind whose hits others follow, leave as far off as vertices of the next coarser level
        // can move, which begin to where the others end, the more of that the nearer they are to it; and not
        // along the normal but back along the ray: beside the surface others may be nearer than that, as in
        // sharp folds, along the ray none is.
        // Vertices of a level move four times as far as those of the next finer one: from half of what the
        // next coarser level's can move to twice that, with which blocks of that level begin.
        vfloat part = part_gone(c, block, s.target, s.hit);
        vfloat above = k.sway_above - k.sway;
        above = above * (part * part);
        vfloat sway = max(k.sway, above + above);
        vfloat off = select(morphs, sway + rounding, rounding);
        vfloat facing_ray = max(dot(s.geometric, toward), 1.0e-3F);
        vfloat half_way = h.t * 0.5F;
        vfloat back = min(off / facing_ray, half_way);
        beyond.before = madd(max(back, rounding), toward, p);
    }
    return s;
}

/// Shading normals as normal maps bend them.
inline void bend_normals(const Context& c, const Materials& of, const Beyond& b, Surface& s) {
    vint maps = of.whole(&MaterialRecord::map_bits);
    maps = maps & vint(normal_bits);
    vmask has = s.hit & (maps > vint(0));
    if (branch(none(has)))
        return;
    vvec bent = s.shading;
    vmask open = has & b.known.open(map_normal);
    if (branch(any(open))) {
        vvec own = s.shading * b.side;
        bent = select(open, mapped_normal(c, of, b.map, own, open) * b.side, bent);
    }
    bent = b.known.mixed(map_normal, b.known.normal, bent);
    s.shading = select(has, normalise(bent, s.shading), s.shading);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
