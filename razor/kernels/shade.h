// Hits to surface points, and the light they receive: a rectangle light and a constant sky, both by shadow
// rays, on matte surfaces. Shadow packets hold width/4 neighbouring hits x 4 samples.
#pragma once

#include "isa/math.h"
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
    vint pixel; // number of the pixel, for sampling
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

[[gnu::noinline]] inline Surface find_surface(const Context& c, const Rays& r, const Hits& h) {
    phase_scope phase(phase_shade);
    Surface s;
    s.hit = h.patch >= vint(0);
    pointer<float> words = as<float>(c.grids);
    TriangleWords t = locate(c, h, s.hit);
    pointer<float> vertices = words + block_header_words;
    vvec a = gather_vec(vertices, t.a, t.stride, s.hit);
    vvec b = gather_vec(vertices, t.b, t.stride, s.hit);
    vvec d = gather_vec(vertices, t.c, t.stride, s.hit);
    vvec toward = r.direction * vfloat(-1.0F);
    vvec edge1 = b - a;
    vvec edge2 = d - a;
    vvec n = normalise(cross(edge1, edge2), toward);
    s.shading = n;

    // Normals of each block that some lane hit, made if this is the first time.
    for (vmask left = s.hit; branch(any(left));) {
        sint block = extract(h.block, first(left));
        vmask here = left & (h.block == vint(block));
        left = left & !here;
        sint normals_at = ensure_normals(c, block);
        if (branch(normals_at != 0)) {
            pointer<float> normals = words + normals_at;
            vvec na = gather_vec(normals, t.a, t.stride, here);
            vvec nb = gather_vec(normals, t.b, t.stride, here);
            vvec nc = gather_vec(normals, t.c, t.stride, here);
            vvec smooth = normalise(blend(na, nb, nc, h), n);
            s.shading = select(here, smooth, s.shading);
        }
    }
    // Both normals face the viewer: surfaces are two-sided.
    vfloat zero(0.0F);
    vmask away = dot(n, toward) < zero;
    vvec flipped = n * vfloat(-1.0F);
    s.geometric = select(away, flipped, n);
    vmask opposed = dot(s.shading, s.geometric) < zero;
    flipped = s.shading * vfloat(-1.0F);
    s.shading = select(opposed, flipped, s.shading);

    constexpr int patch_words = sizeof(PatchRecord) / 4;
    constexpr int mesh_words = sizeof(MeshRecord) / 4;
    vint mesh = gather(field(c.patches, &PatchRecord::mesh), h.patch * vint(patch_words), s.hit);
    vint record = mesh * vint(mesh_words);
    vvec origin = gather_vec(field(c.meshes, &MeshRecord::origin), record, vint(1), s.hit);
    s.albedo = gather_vec(field(c.meshes, &MeshRecord::albedo), record, vint(1), s.hit);
    vvec p = blend(a, b, d, h);
    vfloat error = position_error(p, origin);
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
    vfloat cosines = cos_surface * cos_light;
    l.weight = cosines * (inverse * inverse);
    return l;
}

/// A cosine-distributed direction about the shading normal for each lane. header.sky holds radiance /
/// samples.
inline LightRays sample_sky(const Surface& s, const vint& sample) {
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
    l.weight = vfloat(1.0F);
    return l;
}

inline Surface permute(const Surface& s, const vint& from, const vmask& m) {
    Surface p;
    p.hit = m;
    p.position = permute(s.position, from);
    p.geometric = permute(s.geometric, from);
    p.shading = permute(s.shading, from);
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
                l = sample_sky(here, number + vint(first_sample));
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
