// Hits to surface points, and the light they receive: a rectangle light and a constant sky, both by shadow
// rays, on matte surfaces. Shadow packets hold width/4 neighbouring hits x 4 samples.
#pragma once

#include "isa/math.h"
#include "razor/kernels/differentials.h"
#include "razor/kernels/normals.h"
#include "razor/kernels/sampling.h"
#include "razor/kernels/traverse.h"

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
    vint pixel;            // number of the pixel, for sampling
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

/// Bound on the error of a point computed as a blend of `a`, `b`, `c` and moved by `origin`, and of the reach
/// of a ray that leaves it (pbrt's gamma(n) style: 16 half-ulp roundings of the largest terms).
inline vfloat position_error(const vvec& p, const vvec& origin) {
    vfloat size = largest(abs(p));
    vfloat shift = largest(abs(origin));
    return max(size, shift) * (16.0F / 16777216.0F);
}

/// Normals of a block whose vertices lie blended in `area`, with the same weights, beside them.
inline pointer<float> blend_normals(const Context& c, sint line, pointer<float> normals,
                                    pointer<float> area) {
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
    return x;
}

/// The corners of the triangles hit, and their vertices' normals interpolated (zero where they have none).
struct Corners {
    vvec a, b, c, normal;
    vfloat sway; // of the block's finest vertices
};
/// Block after block; one that was blended for the rays is blended once more.
inline Corners find_triangles(const Context& c, const Hits& h, const vmask& hit) {
    TriangleWords t = locate(c, h, hit);
    vfloat zero(0.0F);
    vvec none_yet{zero, zero, zero};
    Corners k{none_yet, none_yet, none_yet, none_yet, zero};
    vint first_word = h.block << 4;
    vint at_a = t.a - first_word;
    vint at_b = t.b - first_word;
    vint at_c = t.c - first_word;
    for (vmask left = hit; branch(any(left));) {
        sint one = first(left);
        sint block = extract(h.block, one);
        sint leader = extract(h.field, one);
        vmask here = left & (h.block == vint(block));
        here = here & (h.field == vint(leader));
        left = left & !here;
        pointer<float> words = as<float>(c.grids + block);
        sint movable = load(field(as<BlockHeader>(words), &BlockHeader::movable));
        if (branch(movable != 0)) {
            vfloat sway = load_broadcast(field(as<BlockHeader>(words), &BlockHeader::sway));
            k.sway = select(here, sway, k.sway);
        }
        sint normals_at = ensure_normals(c, block);
        pointer<float> vertices = words + block_header_words;
        pointer<float> normals = words + normals_at;
        if (branch(leader >= 0)) {
            sint instance = load(field(as<BlockHeader>(words), &BlockHeader::instance));
            svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
            pointer<float> area = c.stack + scratch_blend;
            tally(c.counters->blended_blocks, 1);
            blend_vertices(c, field_of(c, leader, origin), block, area);
            vertices = area + block_header_words;
            if (branch(normals_at != 0))
                normals = blend_normals(c, block, normals, area);
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
            k.normal = select(here, blend(na, nb, nc, h), k.normal);
        }
    }
    return k;
}

/// Rays that leave a hit begin this far off the surface, in units of how far the finest vertices of its block
/// can move: what they see there is no further from what was hit.
inline constexpr float leaving_share = 0.5F;

/// The target edge length that each ray asks for `way` from its field's origin (see target_at()).
inline vfloat asked_at(const Rays& r, const vvec& way) {
    vfloat distance = sqrt(dot(way, way)) - r.radius;
    distance = max(distance, 0.0F);
    vfloat along = dot(r.slope, way) + r.base;
    vfloat target = fma(r.growth, distance, abs(along));
    return max(target, vfloat(least_target));
}

[[gnu::noinline]] inline Surface find_surface(const Context& c, const Rays& r, const Hits& h) {
    phase_scope phase(phase_shade);
    Surface s;
    s.hit = h.patch >= vint(0);
    Corners k = find_triangles(c, h, s.hit);
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
    vfloat error = position_error(p, origin);
    vmask morphs = vmask(load(field(c.frame, &FrameHeader::morphs)) != 0);
    vfloat apart = fma(k.sway, vfloat(leaving_share), error);
    error = select(morphs, apart, error);
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

/// Hits that lie together share a field, so that blocks need not be blended for each of them: those no
/// further from the first one, in target edge lengths, and whose target edge lengths differ by no more than
/// this factor.
inline constexpr float shared_reach = 16.0F;
inline constexpr float shared_ratio = 1.05F;
/// So far around its hits, in target edge lengths, a field is that of the rays that found them.
inline constexpr float leaving_reach = 8.0F;

/// Rays that leave surfaces go on with the target edge lengths that they begin with. Within the ball that
/// holds its hits a field is constant, and no finer than any ray that found them asked for at its hit: there
/// a convex shape stays behind what was hit of it. Further away it falls back from any ray's plane by more
/// than finer levels can bring it forward (its fall grows with the square of the distance, 32 times what an
/// edge's chord cuts off at leaving_reach), so that from there on targets may shrink as well as grow: as
/// slowly as those of the slowest active ray.
inline void leave_surface(const Context& c, const Surface& s, const vfloat& growth, Rays& r) {
    r.field_origin = s.position;
    r.radius = vfloat(0.0F);
    r.base = s.target;
    r.growth = growth;
    r.leader = lane_index();
    vfloat zero(0.0F);
    r.slope = {zero, zero, zero};
    for (vmask left = s.hit; branch(any(left));) {
        sint leader = first(left);
        vint from = vint(leader);
        vvec centre = permute(s.position, from);
        vfloat target = permute(s.target, from);
        vvec d = s.position - centre;
        vfloat square = dot(d, d);
        vfloat reach = target * shared_reach;
        vmask same = left & (square <= reach * reach);
        same = same & (s.target <= target * shared_ratio);
        same = same & (target <= s.target * shared_ratio);
        same = same | (lane_index() == from);
        left = left & !same;
        vfloat radius = vfloat(reduce_max(select(same, sqrt(square), zero)));
        vfloat steepest = vfloat(reduce_max(select(same, s.growth, zero)));
        vmask rays = same & r.active;
        vfloat slowest = vfloat(reduce_min(select(rays, growth, vfloat(gradation_cap))));
        vfloat base = vfloat(reduce_max(select(same, s.target, zero)));
        base = fma(steepest, radius, base);
        radius = fma(base, vfloat(leaving_reach), radius);
        slowest = max(slowest, vfloat(-gradation_cap));
        r.field_origin = select(same, centre, r.field_origin);
        r.radius = select(same, radius, r.radius);
        r.base = select(same, base, r.base);
        r.growth = select(same, slowest, r.growth);
        r.leader = select(same, from, r.leader);
    }
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    if (branch(fixed > 0.0F))
        fix_target(fixed, r);
}

/// A point on the rectangle light for each lane. header.light_radiance holds radiance x area / (pi x
/// samples).
inline LightRays sample_light(const Context& c, const Surface& s, const vint& sample) {
    vpoint at = sample_square(s.pixel, sample, dimension_light);
    vvec corner = load_broadcast_vec(field(c.frame, &FrameHeader::light_corner));
    vvec edge_u = load_broadcast_vec(field(c.frame, &FrameHeader::light_u));
    vvec edge_v = load_broadcast_vec(field(c.frame, &FrameHeader::light_v));
    vvec normal = load_broadcast_vec(field(c.frame, &FrameHeader::light_normal));
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
    vfloat above = dot(s.geometric, l.rays.direction);
    vfloat cos_light = -dot(normal, l.rays.direction);
    vmask faces = apart & (cos_surface > zero);
    faces = faces & (above > zero);
    faces = faces & (cos_light > zero);
    l.rays.active = s.hit & faces;
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::light_spacing));
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
    return p;
}

/// Sum over `samples` shadow rays a hit of the weights of those that arrive. Sky: directions about the
/// normal; else points on the light. `first_sample` is the number of the camera sample times `samples`.
template <Features F, bool Sky>
[[gnu::noinline]] inline vfloat gather_light(const Context& c, const Surface& s, sint samples,
                                             sint first_sample) {
    phase_scope phase(phase_light);
    constexpr int per_hit = 4;
    constexpr int hits_per_packet = isa::width / per_hit;
    pointer<float> sums = c.packets + packet_sum;
    store_vector(sums, vfloat(0.0F));
    vint order = compress(lane_index(), s.hit);
    sint hits = count(s.hit);
    vint member = lane_index() & vint(per_hit - 1);
    vint rank = lane_index() >> 2;
    for (sint from = 0; branch(from < hits); from += hits_per_packet) {
        vint place = rank + vint(from);
        vmask present = place < vint(hits);
        vint lane = permute(order, place);
        Surface here = permute(s, lane, present);
        for (sint k = 0; branch(k < samples); k += per_hit) {
            vint number = member + vint(k);
            vmask wanted = number < vint(samples);
            LightRays l;
            if constexpr (Sky)
                l = sample_sky(c, here, number + vint(first_sample));
            else
                l = sample_light(c, here, number + vint(first_sample));
            l.rays.active = l.rays.active & wanted;
            if (branch(any(l.rays.active))) {
                tally(c.counters->shadow_packets, 1);
                tally(c.counters->shadow_rays, count(l.rays.active));
                Hits blocked = trace<F, true>(c, l.rays);
                vmask arrives = l.rays.active & (blocked.patch < vint(0));
                vfloat part = select(arrives, l.weight, vfloat(0.0F));
                vint pair = lane_index() ^ vint(1);
                part = part + permute(part, pair);
                pair = lane_index() ^ vint(2);
                part = part + permute(part, pair);
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
