// Hits to surface points, as they are lit.
#pragma once

#include "isa/math.h"
#include "razor/frame/kernel_table.h"
#include "razor/kernels/differentials.h"
#include "razor/kernels/normals.h"
#include "razor/kernels/packet.h"
#include "razor/kernels/sampling.h"

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
};

/// The three vertices of the triangles hit, from component arrays at word `base` of each lane's block.
struct TriangleWords {
    vint a, b, c; // of x; y and z follow at +stride, +2 stride
    vint stride;
};

inline vvec gather_vec(pointer<float> words, const vint& at, const vint& stride, const vmask& m) {
    vvec v;
    v.x = gather(words, at, m);
    vint next = at + stride;
    v.y = gather(words, next, m);
    next = next + stride;
    v.z = gather(words, next, m);
    return v;
}

/// Word numbers, from the grids' base, of the vertices of the triangles hit.
inline TriangleWords locate(const Context& c, const Hits& h, const vmask& m) {
    pointer<std::int32_t> words = as<std::int32_t>(c.grids);
    vint block = h.block << 4;
    constexpr int quads_u_word = offsetof(BlockHeader, quads_u) / 4;
    constexpr int stride_word = offsetof(BlockHeader, stride) / 4;
    vint quads_u = gather(words + quads_u_word, block, m);
    TriangleWords t;
    t.stride = gather(words + stride_word, block, m);
    vint which = h.triangle & vint(1);
    vint quad = (h.triangle >> 1) & vint(63);
    vint row = quad >> block_log2;
    vint column = quad & vint(block_quads - 1);
    vint width = quads_u + vint(1);
    vint low = row * width + column;
    low = low + block;
    vint high = low + width;
    vmask second = which > vint(0);
    t.a = low;
    vint right = low + vint(1);
    vint opposite = high + vint(1);
    t.b = select(second, opposite, right);
    t.c = select(second, high, opposite);
    return t;
}

inline vvec blend(const vvec& a, const vvec& b, const vvec& c, const Hits& h) {
    vfloat w = vfloat(1.0F) - h.u;
    w = w - h.v;
    return madd(h.v, c, madd(h.u, b, a * w));
}

/// Bound on the error of a point computed as a blend of `a`, `b`, `c` and moved by `origin`, and of the
/// distance at which a ray that leaves it meets their plane, from differences to these corners and sheared by
/// up to 2 (pbrt's gamma(n) style: 24 half-ulp roundings of the largest terms).
inline vfloat position_error(const vvec& a, const vvec& b, const vvec& c, const vvec& origin) {
    vfloat of_a = largest(abs(a));
    vfloat of_b = largest(abs(b));
    vfloat of_c = largest(abs(c));
    vfloat shift = largest(abs(origin));
    vfloat size = max(of_a, of_b);
    size = max(size, of_c);
    return max(size, shift) * (24.0F / 16777216.0F);
}

inline void copy_corner_texcoords(pointer<float> own, sint quads_u, sint quads_v, sint stride,
                                  pointer<float> out) {
    for (int k = 0; k < 4; ++k) {
        sint vertex = corner_vertex(k, quads_u, quads_v);
        sfloat u = load(own + vertex);
        store(out + vertex, u);
        sfloat v = load(own + stride + vertex);
        store(out + stride + vertex, v);
    }
}
/// Of one pass' vertices, as normals are.
inline void blend_texcoords(pointer<float> own, const BlendStep& s, const vfloat& weight, sint stride,
                            pointer<float> out, const vmask& m) {
    for (int k = 0; k < 2; ++k) {
        vfloat at = gather(own, s.vertex, m);
        vfloat one = gather(out, s.one, m);
        vfloat other = gather(out, s.other, m);
        vfloat mean = (one + other) * 0.5F;
        scatter(out, s.vertex, fma(weight, at - mean, mean), m);
        own = own + stride;
        out = out + stride;
    }
}

/// Blends the normals of the block whose vertices lie blended in a slot, with the same weights, beside them;
/// Mapped: also texture coordinates.
template <bool Mapped>
inline void blend_normals(const Context& c, sint line, pointer<float> normals, pointer<float> slot) {
    pointer<float> area = slot + slot_block;
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    pointer<float> x = area + blend_normals_at;
    pointer<float> weights = area + blend_weights;
    for (int k = 0; k < 4; ++k) {
        sint vertex = corner_vertex(k, quads_u, quads_v);
        svec n = load_vertex(normals, stride, vertex);
        store(x + vertex, n.x);
        store(x + stride + vertex, n.y);
        store(x + stride * 2 + vertex, n.z);
    }
    sint planes = 0;
    if constexpr (Mapped) {
        sint instance = load(field(block, &BlockHeader::instance));
        planes = load(field(c.instances + instance, &InstanceRecord::shading_planes));
    }
    if constexpr (Mapped) {
        if (branch(planes != 0))
            copy_corner_texcoords(normals + stride * 3, quads_u, quads_v, stride, slot + slot_texcoords);
    }
    pointer<std::int32_t> pass = blend_table(c, quads_u, quads_v);
    for (int p = 0; p < blend_passes; ++p) {
        sint n = load(pass);
        for (sint from = 0; branch(from < n); from += isa::width) {
            vmask m = first_lanes(n - from);
            BlendStep s = load_step(pass, from, m);
            vvec own = gather_vertex(normals, stride, s.vertex, m);
            vvec one = gather_vertex(x, stride, s.one, m);
            vvec other = gather_vertex(x, stride, s.other, m);
            vfloat weight = gather(weights, s.vertex, m);
            vvec q = blend_vertex(weight, own, one, other);
            scatter_vec(x, stride, s.vertex, q, m);
            if constexpr (Mapped) {
                if (branch(planes != 0))
                    blend_texcoords(normals + stride * 3, s, weight, stride, slot + slot_texcoords, m);
            }
        }
        pass = pass + pass_words;
    }
}

/// Returns them, once they are there.
template <bool Mapped>
inline pointer<float> blended_normals(const Context& c, sint line, pointer<float> normals,
                                      pointer<float> slot) {
    build_once(c, as<shared_int>(slot) + slot_normals,
               [&] { blend_normals<Mapped>(c, line, normals, slot); });
    return slot + (slot_block + blend_normals_at);
}

/// The slot that holds the block as the field of that lane sees it.
inline pointer<float> blended_slot(const Context& c, sint lane, sint line) {
    sint number = load(as<std::int32_t>(c.packets + packet_number) + lane);
    Kept kept = find_blended(c, number, line, no_leaf);
    if (branch(!kept.there)) {
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint instance = load(field(block, &BlockHeader::instance));
        svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
        blend_block(c, field_of(c, lane, origin), number, line, no_leaf, kept.slot);
    }
    return kept.slot;
}

/// The corners of the triangles hit, and their vertices' normals interpolated (zero where they have none).
struct Corners {
    vvec a, b, c;
    vvec at_a, at_b, at_c, normal; // normals: of the corners, and between them
    vfloat sway, sway_above;       // of the block's finest vertices; of those of the next coarser level
    vpoint map_a, map_b, map_c;    // texture coordinates, where they are asked for and there are any
};
/// A block between two levels of the paper's scheme, `number` that of the finer one's field: arrays of both
/// levels' vertices, and of their normals.
struct BlockPair {
    pointer<float> fine, coarse, fine_normals, coarse_normals;
};
template <bool Mapped>
inline BlockPair block_pair(const Context& c, sint line, sint number, sint normals_at) {
    sint level = level_of_number(number);
    pointer<float> fine = level_slot(c, level, line);
    pointer<float> coarse = level_slot(c, level + 1, line);
    BlockPair p;
    p.fine = fine + (slot_block + block_header_words);
    p.coarse = coarse + (slot_block + block_header_words);
    if (branch(normals_at != 0)) {
        pointer<float> normals = as<float>(c.grids + line) + normals_at;
        p.fine_normals = blended_normals<Mapped>(c, line, normals, fine);
        p.coarse_normals = blended_normals<Mapped>(c, line, normals, coarse);
    }
    return p;
}

/// The vertex and its normal where each ray sees them.
inline void find_between(const BlockPair& p, const Scale& s, const vvec& from, sint number, const vint& at,
                         const vint& stride, sint normals_at, const vmask& m, vvec& vertex, vvec& normal) {
    vvec fine = gather_vec(p.fine, at, stride, m);
    vvec coarse = gather_vec(p.coarse, at, stride, m);
    sint level = level_of_number(number);
    vfloat weight = pair_weight(s, dot(fine - from, s.direction), level);
    vertex = select(m, blend_pair(weight, fine, coarse), vertex);
    if (branch(normals_at != 0)) {
        fine = gather_vec(p.fine_normals, at, stride, m);
        coarse = gather_vec(p.coarse_normals, at, stride, m);
        normal = select(m, blend_pair(weight, fine, coarse), normal);
    }
}

/// Texture coordinates of a corner of the triangles hit, `texcoords` being those of the block, u[stride],
/// v[stride].
inline void gather_texcoord(pointer<float> texcoords, const vint& corner, const vint& stride,
                            const vmask& here, vpoint& at) {
    vfloat u = gather(texcoords, corner, here);
    vfloat v = gather(texcoords, corner + stride, here);
    at.u = select(here, u, at.u);
    at.v = select(here, v, at.v);
}

/// Block after block.
template <bool Mapped, bool Glossy>
inline Corners find_triangles(const Context& c, const Rays& r, const Hits& h, const vmask& hit) {
    TriangleWords t = locate(c, h, hit);
    vfloat zero(0.0F);
    vvec none_yet{zero, zero, zero};
    Corners k{none_yet, none_yet, none_yet, none_yet, none_yet, none_yet, none_yet, zero, zero, {}, {}, {}};
    if constexpr (Mapped)
        k.map_a = k.map_b = k.map_c = {zero, zero};
    vint first_word = h.block << 4;
    vint at_a = t.a - first_word;
    vint at_b = t.b - first_word;
    vint at_c = t.c - first_word;
    for (vmask left = hit; branch(any(left));) {
        sint one = first(left);
        sint block = extract(h.block, one);
        sint lane = extract(h.field, one);
        vmask here = left & (h.block == vint(block));
        here = here & (h.field == vint(lane));
        left = left & !here;
        pointer<float> words = as<float>(c.grids + block);
        sint corners_at = load(field(as<BlockHeader>(words), &BlockHeader::corners_at));
        if (branch(corners_at != no_vertex_moves)) {
            pointer<float> sways = field(as<BlockHeader>(words), &BlockHeader::sway);
            k.sway = select(here, load_broadcast(sways), k.sway);
            if constexpr (Glossy)
                k.sway_above = select(here, load_broadcast(sways + 1), k.sway_above);
        }
        sint normals_at = ensure_normals(c, block);
        sint planes = 0;
        if constexpr (Mapped) {
            sint instance = load(field(as<BlockHeader>(words), &BlockHeader::instance));
            planes = load(field(c.instances + instance, &InstanceRecord::shading_planes));
        }
        const auto find_texcoords = [&](pointer<float> texcoords) {
            if (branch(planes != 0)) {
                gather_texcoord(texcoords, at_a, t.stride, here, k.map_a);
                gather_texcoord(texcoords, at_b, t.stride, here, k.map_b);
                gather_texcoord(texcoords, at_c, t.stride, here, k.map_c);
            }
        };
        if (branch(lane < -1)) {
            BlockPair p = block_pair<Mapped>(c, block, lane, normals_at);
            Scale scale = scale_of(c, r);
            sint instance = load(field(as<BlockHeader>(words), &BlockHeader::instance));
            svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
            vvec from = r.origin - broadcast(origin);
            find_between(p, scale, from, lane, at_a, t.stride, normals_at, here, k.a, k.at_a);
            find_between(p, scale, from, lane, at_b, t.stride, normals_at, here, k.b, k.at_b);
            find_between(p, scale, from, lane, at_c, t.stride, normals_at, here, k.c, k.at_c);
            k.normal = select(here, blend(k.at_a, k.at_b, k.at_c, h), k.normal);
            if constexpr (Mapped) { // as they are at the anchors
                sint after = load(field(as<BlockHeader>(words), &BlockHeader::stride)) * 3;
                find_texcoords(words + normals_at + after);
            }
            continue;
        }
        pointer<float> vertices = words + block_header_words;
        pointer<float> normals = words + normals_at;
        pointer<float> texcoords = normals;
        if constexpr (Mapped) {
            sint after = load(field(as<BlockHeader>(words), &BlockHeader::stride)) * 3;
            texcoords = normals + after;
        }
        if (branch(lane >= 0)) {
            pointer<float> slot = blended_slot(c, lane, block);
            vertices = slot + (slot_block + block_header_words);
            if (branch(normals_at != 0))
                normals = blended_normals<Mapped>(c, block, normals, slot);
            texcoords = slot + slot_texcoords;
        }
        if constexpr (Mapped) {
            find_texcoords(texcoords);
        }
        vvec a = gather_vec(vertices, at_a, t.stride, here);
        vvec b = gather_vec(vertices, at_b, t.stride, here);
        vvec d = gather_vec(vertices, at_c, t.stride, here);
        k.a = select(here, a, k.a);
        k.b = select(here, b, k.b);
        k.c = select(here, d, k.c);
        if (branch(normals_at != 0)) {
            vvec na = gather_vec(normals, at_a, t.stride, here);
            vvec nb = gather_vec(normals, at_b, t.stride, here);
            vvec nc = gather_vec(normals, at_c, t.stride, here);
            k.at_a = select(here, na, k.at_a);
            k.at_b = select(here, nb, k.at_b);
            k.at_c = select(here, nc, k.at_c);
            k.normal = select(here, blend(na, nb, nc, h), k.normal);
        }
    }
    return k;
}

/// The target edge length that each ray asks for `way` from its field's origin (see target_at()).
inline vfloat asked_at(const Rays& r, const vvec& way) {
    vfloat distance = sqrt(dot(way, way)) - r.radius;
    distance = max(distance, 0.0F);
    vfloat along = dot(r.slope, way) + r.base;
    vfloat target = fma(r.growth, distance, abs(along));
    return max(target, vfloat(least_target));
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

/// Where a hit lies on its texture, and how.
struct Mapping {
    vpoint at;
    vfloat footprint; // the area, in texture coordinates, that the ray asked for
    vvec along_u;     // directions on the surface: unit, at right angles to the normal
    vvec along_v;
};

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
    vfloat asked = (target * target) / inclined;
    asked = asked / surface;
    map.footprint = abs(across) * asked;
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

/// `beyond` is filled in for looks that need it.
template <Look L>
[[gnu::noinline]] inline Surface find_surface(const Context& c, const Rays& r, const Hits& h,
                                              Beyond& beyond) {
    phase_scope phase(phase_shade);
    Surface s;
    s.hit = h.patch >= vint(0);
    constexpr bool mapped = L == look_mapped || L == look_glossy_mapped;
    constexpr bool glossy = L == look_glossy || L == look_glossy_mapped;
    Corners k = find_triangles<mapped, glossy>(c, r, h, s.hit);
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
    vint record = instance * vint(instance_words);
    vvec origin = gather_vec(field(c.instances, &InstanceRecord::origin), record, vint(1), s.hit);
    if constexpr (L == look_matte)
        s.albedo = gather_vec(field(c.instances, &InstanceRecord::albedo), record, vint(1), s.hit);
    vvec p = blend(k.a, k.b, k.c, h);
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
    }
    p = p + lift_of(k, h, p, side);
    p = p + origin;
    // Rays to lights leave as far off the surface as the finest vertices of its block can move: what they see
    // there is no further from what was hit.
    s.position = madd(error, s.geometric, p);
    if constexpr (glossy) {
        // Bounces, behind whose hits others follow, leave as far off as vertices of the next coarser level
        // can move, which begin to where the others end; and not along the normal but back along the ray:
        // beside the surface others may be nearer than that, as in sharp folds, along the ray none is.
        vfloat sway = max(k.sway, k.sway_above);
        vfloat off = select(morphs, sway + rounding, rounding);
        vfloat facing_ray = max(dot(s.geometric, toward), 1.0e-3F);
        vfloat half_way = h.t * 0.5F;
        vfloat back = min(off / facing_ray, half_way);
        beyond.before = madd(max(back, rounding), toward, p);
    }
    return s;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
