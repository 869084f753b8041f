// Hits to surface points, and the light they receive: rectangle lights and a constant sky, both by shadow
// rays, on matte surfaces. Shadow packets hold width/4 neighbouring hits x 4 samples.
#pragma once

#include "isa/math.h"
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

/// Blends the normals of the block whose vertices lie blended in a slot, with the same weights, beside them.
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
        }
        pass = pass + pass_words;
    }
}

/// Returns them, once they are there.
inline pointer<float> blended_normals(const Context& c, sint line, pointer<float> normals,
                                      pointer<float> slot) {
    build_once(c, as<shared_int>(slot) + slot_normals, [&] { blend_normals(c, line, normals, slot); });
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
    vfloat sway;                   // of the block's finest vertices
};
/// A block between two levels of the paper's scheme, `number` that of the finer one's field: arrays of both
/// levels' vertices, and of their normals.
struct BlockPair {
    pointer<float> fine, coarse, fine_normals, coarse_normals;
};
inline BlockPair block_pair(const Context& c, sint line, sint number, sint normals_at) {
    sint level = level_of_number(number);
    pointer<float> fine = level_slot(c, level, line);
    pointer<float> coarse = level_slot(c, level + 1, line);
    BlockPair p;
    p.fine = fine + (slot_block + block_header_words);
    p.coarse = coarse + (slot_block + block_header_words);
    if (branch(normals_at != 0)) {
        pointer<float> normals = as<float>(c.grids + line) + normals_at;
        p.fine_normals = blended_normals(c, line, normals, fine);
        p.coarse_normals = blended_normals(c, line, normals, coarse);
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

/// Block after block.
inline Corners find_triangles(const Context& c, const Rays& r, const Hits& h, const vmask& hit) {
    TriangleWords t = locate(c, h, hit);
    vfloat zero(0.0F);
    vvec none_yet{zero, zero, zero};
    Corners k{none_yet, none_yet, none_yet, none_yet, none_yet, none_yet, none_yet, zero};
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
            vfloat sway = load_broadcast(field(as<BlockHeader>(words), &BlockHeader::sway));
            k.sway = select(here, sway, k.sway);
        }
        sint normals_at = ensure_normals(c, block);
        if (branch(lane < -1)) {
            BlockPair p = block_pair(c, block, lane, normals_at);
            Scale scale = scale_of(c, r);
            sint instance = load(field(as<BlockHeader>(words), &BlockHeader::instance));
            svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
            vvec from = r.origin - broadcast(origin);
            find_between(p, scale, from, lane, at_a, t.stride, normals_at, here, k.a, k.at_a);
            find_between(p, scale, from, lane, at_b, t.stride, normals_at, here, k.b, k.at_b);
            find_between(p, scale, from, lane, at_c, t.stride, normals_at, here, k.c, k.at_c);
            k.normal = select(here, blend(k.at_a, k.at_b, k.at_c, h), k.normal);
            continue;
        }
        pointer<float> vertices = words + block_header_words;
        pointer<float> normals = words + normals_at;
        if (branch(lane >= 0)) {
            pointer<float> slot = blended_slot(c, lane, block);
            vertices = slot + (slot_block + block_header_words);
            if (branch(normals_at != 0))
                normals = blended_normals(c, block, normals, slot);
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

/// Rays that leave a hit begin this far off the surface, in units of how far the finest vertices of its block
/// can move: what they see there is no further from what was hit.
inline constexpr float leaving_share = 1.0F;

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

[[gnu::noinline]] inline Surface find_surface(const Context& c, const Rays& r, const Hits& h) {
    phase_scope phase(phase_shade);
    Surface s;
    s.hit = h.patch >= vint(0);
    Corners k = find_triangles(c, r, h, s.hit);
    vvec toward = r.direction * vfloat(-1.0F);
    vvec edge1 = k.b - k.a;
    vvec edge2 = k.c - k.a;
    vvec n = normalise(cross(edge1, edge2), toward);
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
    s.albedo = gather_vec(field(c.instances, &InstanceRecord::albedo), record, vint(1), s.hit);
    vvec p = blend(k.a, k.b, k.c, h);
    vfloat error = position_error(k.a, k.b, k.c, origin);
    vmask morphs = vmask(load(field(c.frame, &FrameHeader::morphs)) != 0);
    vfloat apart = fma(k.sway, vfloat(leaving_share), error);
    error = select(morphs, apart, error);
    vfloat side = select(opposed, vfloat(-1.0F), vfloat(1.0F));
    p = p + lift_of(k, h, p, side);
    p = p + origin;
    s.position = madd(error, s.geometric, p);
    return s;
}

} // namespace shade_kernel

inline namespace light_kernel {

/// A unit vector around which `n` is the z axis: branch-free orthonormal basis (Duff et al., JCGT 2017).
inline vvec to_world(const vvec& n, const vfloat& x, const vfloat& y, const vfloat& z) {
    vint sign_bit = as_int(n.z) & vint(std::int32_t(0x80000000U));
    vfloat sign = as_float(sign_bit | as_int(vfloat(1.0F)));
    vfloat a = vfloat(-1.0F) / (sign + n.z);
    vfloat b = n.x * n.y * a;
    vfloat sx = sign * n.x;
    vvec tangent;
    tangent.x = fma(sx, n.x * a, vfloat(1.0F));
    tangent.y = sign * b;
    tangent.z = -sx;
    vvec bitangent;
    bitangent.x = b;
    vfloat ya = n.y * a;
    bitangent.y = fma(n.y, ya, sign);
    bitangent.z = -n.y;
    vvec w = madd(y, bitangent, tangent * x);
    return madd(z, n, w);
}

/// Rays to the light and what they carry if nothing is in the way.
struct LightRays {
    Rays rays;
    vfloat weight; // of the light's radiance (or the sky's), before albedo
};

/// Rays that leave hits near each other share a field, whatever packet they are in, so that blocks need not
/// be blended for each of them: hits no further from the first one, in target edge lengths, and whose target
/// edge lengths differ by no more than this factor.
inline constexpr float shared_reach = 16.0F;
inline constexpr float shared_ratio = 1.05F;
inline constexpr float growth_steps = 8.0F; // from 0 to the cap
/// So far around its hits, in target edge lengths, a field is that of the rays that found them.
inline constexpr float leaving_reach = 8.0F;

inline void forget_fields(const Context& c) {
    for (int i = 0; i < left_fields; ++i)
        store(as<std::int32_t>(c.packets + (packet_left + i * left_floats)) + left_number, -1);
    store(as<std::int32_t>(c.packets + packet_left_next), 0);
}

/// Puts a field around lane `lane`'s hit where it is found again. Within the ball that holds its hits the
/// field is constant, and no finer than any ray that found them asked for at its hit.
inline pointer<float> make_field(const Context& c, const Surface& s, sfloat growth, sint lane) {
    pointer<std::int32_t> next = as<std::int32_t>(c.packets + packet_left_next);
    sint slot = load(next);
    store(next, (slot + 1) & (left_fields - 1));
    pointer<float> f = c.packets + (packet_left + slot * left_floats);
    sfloat target = extract(s.target, lane);
    sfloat reach = target * shared_reach;
    sfloat base = target * shared_ratio; // that of no hit is larger
    store(f + left_origin, extract(s.position.x, lane));
    store(f + left_origin + 1, extract(s.position.y, lane));
    store(f + left_origin + 2, extract(s.position.z, lane));
    store(f + left_reach, reach);
    store(f + left_radius, fma(base, leaving_reach, reach));
    store(f + left_base, base);
    store(f + left_growth, growth);
    store(f + left_least, target * (1.0F / shared_ratio));
    store(f + left_most, base);
    sint number = load(field(c.self, &WorkerRecord::next_field));
    store(as<std::int32_t>(f) + left_number, number);
    store(field(c.self, &WorkerRecord::next_field), number + 1);
    return f;
}

/// Gives a kept field to those of the lanes `left` that may share it, and takes them from there.
inline void share_field(pointer<float> f, const Surface& s, vmask& left, Rays& r) {
    vvec origin = load_broadcast_vec(f + left_origin);
    vfloat reach = load_broadcast(f + left_reach);
    vvec d = s.position - origin;
    vfloat square = dot(d, d);
    vfloat most_square = reach * reach;
    vmask same = left & (square <= most_square);
    vfloat least = load_broadcast(f + left_least);
    same = same & (s.target >= least);
    vfloat most = load_broadcast(f + left_most);
    same = same & (s.target <= most);
    if (branch(none(same)))
        return;
    left = left & !same;
    r.field_origin = select(same, origin, r.field_origin);
    r.radius = select(same, load_broadcast(f + left_radius), r.radius);
    r.base = select(same, load_broadcast(f + left_base), r.base);
    r.number = select(same, load_broadcast(as<std::int32_t>(f) + left_number), r.number);
}

/// The growth that all rays of a packet go on with: the slowest that one of them asks for, rounded down to
/// one of a few, so that packets agree.
inline vfloat common_growth(const vmask& active, const vfloat& growth) {
    constexpr float steps = growth_steps / gradation_cap;
    vfloat cap(gradation_cap);
    vfloat slowest = vfloat(reduce_min(select(active, growth, cap)));
    slowest = max(slowest, -cap);
    vfloat shifted = fma(slowest, vfloat(steps), vfloat(growth_steps));
    vint step = to_int(shifted);
    vfloat whole = to_float(step) * vfloat(1.0F / steps);
    return whole - cap;
}

/// Rays that leave surfaces go on with the target edge lengths that they begin with. Within the ball that
/// holds its hits a field is constant, and no finer than any ray that found them asked for at its hit: there
/// a convex shape stays behind what was hit of it. Further away it falls back from any ray's plane by more
/// than finer levels can bring it forward (its fall grows with the square of the distance, 32 times what an
/// edge's chord cuts off at leaving_reach), so that from there on targets may shrink as well as grow.
inline void leave_surface(const Context& c, const Surface& s, const vfloat& wanted, Rays& r) {
    r.field_origin = s.position;
    r.radius = vfloat(0.0F);
    r.base = s.target;
    r.growth = common_growth(r.active, wanted);
    vfloat zero(0.0F);
    r.slope = {zero, zero, zero};
    r.number = vint(-1);
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    if (branch(fixed > 0.0F)) {
        fix_target(fixed, r);
        return;
    }
    sint one_field = load(field(c.frame, &FrameHeader::one_field));
    if (branch(one_field != 0)) {
        ask_for_camera(c, r);
        return;
    }
    sfloat growth = extract(r.growth, 0);
    vmask left = s.hit;
    for (int i = 0; i < left_fields; ++i) {
        pointer<float> f = c.packets + (packet_left + i * left_floats);
        sbool fits = load(as<std::int32_t>(f) + left_number) >= 0;
        fits = fits & (load(f + left_growth) == growth);
        fits = fits & any(left);
        if (branch(fits))
            share_field(f, s, left, r);
    }
    while (branch(any(left))) {
        sint lane = first(left);
        pointer<float> f = make_field(c, s, growth, lane);
        share_field(f, s, left, r);
        left = left & (lane_index() != vint(lane)); // one at no place at all does not find even itself
    }
}

/// A point on the rectangle light for each lane.
inline LightRays sample_light(const Context& c, const Surface& s, pointer<LightRecord> light,
                              const vint& sample) {
    sint dimension = load(field(light, &LightRecord::dimension));
    vpoint at = sample_square(s.pixel, sample, dimension);
    vvec corner = load_broadcast_vec(field(light, &LightRecord::corner));
    vvec edge_u = load_broadcast_vec(field(light, &LightRecord::edge_u));
    vvec edge_v = load_broadcast_vec(field(light, &LightRecord::edge_v));
    vvec normal = load_broadcast_vec(field(light, &LightRecord::normal));
    vvec point = madd(at.v, edge_v, madd(at.u, edge_u, corner));
    vvec way = point - s.position;
    vfloat square = dot(way, way);
    vfloat zero(0.0F);
    vmask apart = square > zero;
    vfloat inverse = reciprocal_sqrt(select(apart, square, vfloat(1.0F)));
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = way * inverse;
    l.rays.t_min = zero;
    l.rays.t_max = (square * inverse) * (1.0F - 1.0e-5F);
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vfloat cos_light = -dot(normal, l.rays.direction);
    vmask faces = apart & (cos_surface > zero);
    faces = faces & (cos_light > zero);
    l.rays.active = s.hit & faces;
    vfloat spacing = load_broadcast(field(light, &LightRecord::spacing));
    leave_surface(c, s, growth_to_area(s.target, spacing, cos_light, inverse), l.rays);
    vfloat cosines = cos_surface * cos_light;
    l.weight = cosines * (inverse * inverse);
    return l;
}

/// A cosine-distributed direction about the shading normal for each lane. header.sky holds radiance /
/// samples.
inline LightRays sample_sky(const Context& c, const Surface& s, const vint& sample) {
    vpoint at = sample_square(s.pixel, sample, dimension_sky);
    vfloat radius = sqrt(at.u);
    vfloat height = sqrt(vfloat(1.0F) - at.u);
    vfloat angle = at.v * 6.28318530717958647692F;
    vfloat x = radius * cos(angle);
    vfloat y = radius * sin(angle);
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = to_world(s.shading, x, y, height);
    vfloat zero(0.0F);
    l.rays.t_min = zero;
    l.rays.t_max = vfloat(infinite);
    l.rays.active = s.hit & (dot(s.geometric, l.rays.direction) > zero);
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::sky_spacing));
    leave_surface(c, s, growth_to_sky(spacing, height), l.rays);
    l.weight = vfloat(1.0F);
    return l;
}

inline Surface permute(const Surface& s, const vint& from, const vmask& m) {
    Surface p;
    p.hit = m;
    p.position = permute(s.position, from);
    p.geometric = permute(s.geometric, from);
    p.shading = permute(s.shading, from);
    p.target = permute(s.target, from);
    p.growth = permute(s.growth, from);
    p.pixel = permute(s.pixel, from);
    p.sample = permute(s.sample, from);
    return p;
}

/// Rays of one hit in a packet, at most: 2^rays_log2.
inline constexpr int rays_of_hit_log2 = 2;

/// Where shadow rays go: to points of one light, or in directions about the normal.
struct TowardsLight {
    static constexpr RayKind kind = kind_light;
    pointer<LightRecord> light;
    LightRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_light(c, s, light, number);
    }
};
struct TowardsSky {
    static constexpr RayKind kind = kind_sky;
    LightRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_sky(c, s, number);
    }
};

/// Sum over `samples` shadow rays a hit of the weights of those that arrive.
template <Features F, class Towards>
[[gnu::noinline]] inline vfloat gather_light(const Context& c, const Surface& s, const Towards& towards,
                                             sint samples) {
    phase_scope phase(phase_light);
    // Few samples leave room for more hits.
    sint fewer_log2 = samples - 1;
    sint per_hit_log2 = select(samples > 2, sint(rays_of_hit_log2), fewer_log2);
    sint per_hit = sint(1) << per_hit_log2;
    sint hits_per_packet = sint(isa::width) >> per_hit_log2;
    pointer<float> sums = c.packets + packet_sum;
    store_vector(sums, vfloat(0.0F));
    vint order = compress(lane_index(), s.hit);
    sint hits = count(s.hit);
    vint member = lane_index() & vint(per_hit - 1);
    vint rank = lane_index() >> vint(per_hit_log2);
    for (sint from = 0; branch(from < hits); from += hits_per_packet) {
        vint place = rank + vint(from);
        vmask present = place < vint(hits);
        vint lane = permute(order, place);
        Surface here = permute(s, lane, present);
        vint first_sample = here.sample * vint(samples);
        for (sint k = 0; branch(k < samples); k += per_hit) {
            vint number = member + vint(k);
            vmask wanted = number < vint(samples);
            LightRays l = towards.sample(c, here, number + first_sample);
            l.rays.active = l.rays.active & wanted;
            if (branch(any(l.rays.active))) {
                Hits blocked = trace_packet<F, Towards::kind>(c, l.rays);
                vmask arrives = l.rays.active & (blocked.patch < vint(0));
                vfloat part = select(arrives, l.weight, vfloat(0.0F));
                for (sint step = 1; branch(step < per_hit); step = step + step) {
                    vint pair = lane_index() ^ vint(step);
                    part = part + permute(part, pair);
                }
                vmask leader = present & (member == vint(0));
                vfloat before = gather(sums, lane, leader);
                scatter(sums, lane, before + part, leader);
            }
        }
    }
    return load_vector(sums);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
