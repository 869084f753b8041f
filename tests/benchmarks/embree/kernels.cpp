// Tessellation and shading of the baseline, compiled once a target. Where a sample lies, where a ray leaves a
// surface and how light is weighed is Razor's own code; rays are traced by Embree, sixteen at once.
#include "razor/kernels/light_samples.h"
#include "tests/benchmarks/embree/records.h"

#include <algorithm>
#include <cstddef>

namespace razor::ISA_TARGET {
namespace {

using namespace razor::baseline;

constexpr int packet = 16; // rays that Embree takes at once
static_assert(isa::width % packet == 0, "the baseline needs vectors of at least sixteen lanes");
constexpr int packets = isa::width / packet;

using lanes = float[isa::width];
using int_lanes = std::int32_t[isa::width];

pointer<const float> at(const float* p) {
    return pointer<const float>(p);
}

void tessellate_block(const TessellateArguments& a, const GridBlock& b) {
    for (int from = 0; from < b.row; from += isa::width) {
        vfloat zero(0.0F);
        vvec p{zero, zero, zero}, du = p, dv = p;
        const float* weights = a.weights + b.weights + from;
        const float* slopes = a.weights + (b.derivatives < 0 ? 0 : b.derivatives) + from;
        for (int i = 0; i < b.controls; ++i) {
            const float* xyz = a.points + 3 * a.controls[b.first_control + i];
            vvec control = load_broadcast_vec(at(xyz));
            p = madd(load_vector(at(weights + i * b.row)), control, p);
            if (b.derivatives >= 0) {
                du = madd(load_vector(at(slopes + 2 * i * b.row)), control, du);
                dv = madd(load_vector(at(slopes + (2 * i + 1) * b.row)), control, dv);
            }
        }
        vvec n = normalise(cross(du, dv), {zero, zero, zero});
        alignas(64) lanes column[6];
        const vfloat* value[6] = {&p.x, &p.y, &p.z, &n.x, &n.y, &n.z};
        for (int k = 0; k < 6; ++k)
            store_vector(pointer<float>(column[k]), *value[k]);
        const int end = std::min(isa::width, b.vertices - from);
        float* position = a.positions + 3 * (b.first_vertex + from);
        float* normal = a.normals + 3 * (b.first_vertex + from);
        for (int l = 0; l < end; ++l)
            for (int k = 0; k < 3; ++k) {
                position[3 * l + k] = column[k][l];
                normal[3 * l + k] = column[3 + k][l];
            }
    }
}

void tessellate(const TessellateArguments& a) {
    for (int i = 0; i < a.count; ++i)
        tessellate_block(a, a.blocks[i]);
}

/// A vector of rays as Embree takes them. Inactive ones are finite and end before they begin: where the
/// processor has no sixteen lanes, Embree takes packets as streams, looks at no mask, and knows idle rays by
/// that alone.
void fill(RTCRay16* rays, const Rays& r) {
    alignas(64) lanes column[8];
    vfloat zero(0.0F);
    vvec origin = select(r.active, r.origin, {zero, zero, zero});
    vvec direction = select(r.active, r.direction, {zero, zero, vfloat(1.0F)});
    vfloat t_min = select(r.active, r.t_min, zero);
    vfloat t_max = select(r.active, r.t_max, vfloat(-1.0F));
    const vfloat* value[8] = {&origin.x,    &origin.y,    &origin.z,    &t_min,
                              &direction.x, &direction.y, &direction.z, &t_max};
    for (int k = 0; k < 8; ++k)
        store_vector(pointer<float>(column[k]), *value[k]);
    for (int i = 0; i < packets; ++i) {
        float* member[8] = {rays[i].org_x, rays[i].org_y, rays[i].org_z, rays[i].tnear,
                            rays[i].dir_x, rays[i].dir_y, rays[i].dir_z, rays[i].tfar};
        for (int k = 0; k < 8; ++k)
            std::copy_n(column[k] + packet * i, packet, member[k]);
        std::fill_n(rays[i].time, packet, 0.0F);
        std::fill_n(rays[i].mask, packet, ~0U);
        std::fill_n(rays[i].flags, packet, 0U);
    }
}

void store_mask(int_lanes& to, const vmask& m) {
    store_vector(pointer<std::int32_t>(to), select(m, vint(-1), vint(0)));
}

bool any_of(const std::int32_t* valid) {
    return std::any_of(valid, valid + packet, [](std::int32_t v) { return v != 0; });
}

struct Found {
    vfloat t, u, v;
    vint piece, quad;
    vmask hit;
};

Found find_closest(const RenderArguments& a, const Rays& r) {
    alignas(64) RTCRayHit16 rays[packets];
    alignas(64) int_lanes valid;
    store_mask(valid, r.active);
    {
        RTCRay16 only[packets];
        fill(only, r);
        for (int i = 0; i < packets; ++i)
            rays[i].ray = only[i];
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) lanes t, u, v;
    alignas(64) int_lanes piece, quad;
    for (int i = 0; i < packets; ++i) {
        RTCHit16& hit = rays[i].hit;
        std::fill_n(hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
        if (any_of(valid + packet * i))
            rtcIntersect16(valid + packet * i, a.scene, &context, &rays[i]);
        for (int l = 0; l < packet; ++l) {
            const unsigned id =
                hit.instID[0][l] != RTC_INVALID_GEOMETRY_ID ? hit.instID[0][l] : hit.geomID[l];
            piece[packet * i + l] = static_cast<std::int32_t>(id);
            quad[packet * i + l] = static_cast<std::int32_t>(hit.primID[l]);
        }
        std::copy_n(hit.u, packet, u + packet * i);
        std::copy_n(hit.v, packet, v + packet * i);
        std::copy_n(rays[i].ray.tfar, packet, t + packet * i);
    }
    Found f;
    f.t = load_vector(at(t));
    f.u = load_vector(at(u));
    f.v = load_vector(at(v));
    f.piece = load_vector(pointer<const std::int32_t>(piece));
    f.quad = load_vector(pointer<const std::int32_t>(quad));
    f.hit = r.active & (f.piece >= vint(0));
    return f;
}

/// Which of the active rays nothing is in the way of.
vmask find_open(const RenderArguments& a, const Rays& r, unsigned flags) {
    alignas(64) RTCRay16 rays[packets];
    alignas(64) int_lanes valid;
    store_mask(valid, r.active);
    fill(rays, r);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = static_cast<RTCIntersectContextFlags>(flags);
    alignas(64) lanes t;
    for (int i = 0; i < packets; ++i) {
        if (any_of(valid + packet * i))
            rtcOccluded16(valid + packet * i, a.scene, &context, &rays[i]);
        std::copy_n(rays[i].tfar, packet, t + packet * i);
    }
    vfloat left = load_vector(at(t));
    return r.active & (left >= vfloat(0.0F));
}

constexpr int piece_words = sizeof(Piece) / 4;

vfloat gather_field(const RenderArguments& a, const vint& piece, std::size_t offset, const vmask& m) {
    pointer<const float> base(reinterpret_cast<const float*>(a.pieces) + offset / 4);
    return gather(base, piece * vint(piece_words), m);
}
vint gather_whole(const RenderArguments& a, const vint& piece, std::size_t offset, const vmask& m) {
    pointer<const std::int32_t> base(reinterpret_cast<const std::int32_t*>(a.pieces) + offset / 4);
    return gather(base, piece * vint(piece_words), m);
}
vvec gather_three(const float* base, const vint& word, const vmask& m) {
    return {gather(at(base), word, m), gather(at(base + 1), word, m), gather(at(base + 2), word, m)};
}

/// Takes directions and places of moved pieces into the scene.
struct Mover {
    vvec row[3], shift, cofactors[3];
    vmask moved;

    Mover(const RenderArguments& a, const vint& piece, const vmask& m) : moved(m) {
        const auto three = [&](std::size_t offset) {
            return vvec{gather_field(a, piece, offset, m), gather_field(a, piece, offset + 4, m),
                        gather_field(a, piece, offset + 8, m)};
        };
        for (std::size_t k = 0; k < 3; ++k) {
            row[k] = three(offsetof(Piece, linear) + 12 * k);
            cofactors[k] = three(offsetof(Piece, cofactors) + 12 * k);
        }
        shift = three(offsetof(Piece, shift));
    }
    void place(vvec& p) const {
        vvec q{dot(row[0], p), dot(row[1], p), dot(row[2], p)};
        p = select(moved, q + shift, p);
    }
    void turn(vvec& n) const {
        vfloat zero(0.0F);
        vvec q{dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)};
        n = select(moved, normalise(q, {zero, zero, zero}), n);
    }
};

/// As find_surface() of razor/kernels/shade.h.
Surface surface_of(const RenderArguments& a, const Rays& r, const Found& f) {
    const vmask& m = f.hit;
    vint first_quad = gather_whole(a, f.piece, offsetof(Piece, first_quad), m);
    vint first_vertex = gather_whole(a, f.piece, offsetof(Piece, first_vertex), m);
    vint word = (first_quad + f.quad) << 2;
    vint corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = (gather(pointer<const std::int32_t>(a.quads + k), word, m) + first_vertex) * vint(3);
    // Of a quad Embree hits (0, 1, 3), or beyond their diagonal (2, 3, 1); of the corners that begin with 1
    // the same triangles are those of Razor, whose normals then agree in the signs of zeros.
    vmask second = (f.u + f.v) > vfloat(1.0F);
    vint at_a = corner[1];
    vint at_b = select(second, corner[2], corner[3]);
    vint at_c = select(second, corner[3], corner[0]);
    vfloat rest = (vfloat(1.0F) - f.u) - f.v;
    Hits h;
    h.u = select(second, -rest, f.v);
    h.v = select(second, vfloat(1.0F) - f.u, rest);
    h.t = f.t;
    Corners k;
    k.a = gather_three(a.positions, at_a, m);
    k.b = gather_three(a.positions, at_b, m);
    k.c = gather_three(a.positions, at_c, m);
    k.at_a = gather_three(a.normals, at_a, m);
    k.at_b = gather_three(a.normals, at_b, m);
    k.at_c = gather_three(a.normals, at_c, m);
    vmask moved = m & (gather_whole(a, f.piece, offsetof(Piece, moved), m) != vint(0));
    if (branch(any(moved))) {
        Mover mover(a, f.piece, moved);
        for (vvec* p : {&k.a, &k.b, &k.c})
            mover.place(*p);
        for (vvec* n : {&k.at_a, &k.at_b, &k.at_c})
            mover.turn(*n);
    }
    k.normal = blend(k.at_a, k.at_b, k.at_c, h);
    Surface s;
    s.hit = m;
    vvec toward = r.direction * vfloat(-1.0F);
    vvec n = normalise(cross(k.b - k.a, k.c - k.a), toward);
    s.shading = normalise(k.normal, n);
    vfloat zero(0.0F);
    s.geometric = select(dot(n, toward) < zero, n * vfloat(-1.0F), n);
    vmask opposed = dot(s.shading, s.geometric) < zero;
    s.shading = select(opposed, s.shading * vfloat(-1.0F), s.shading);
    for (std::size_t c = 0; c < 3; ++c) {
        vfloat* to[3] = {&s.albedo.x, &s.albedo.y, &s.albedo.z};
        *to[c] = gather_field(a, f.piece, offsetof(Piece, albedo) + 4 * c, m);
    }
    vvec p = blend(k.a, k.b, k.c, h);
    vfloat side = select(opposed, vfloat(-1.0F), vfloat(1.0F));
    vfloat error = position_error(k.a, k.b, k.c, {zero, zero, zero});
    s.position = madd(error, s.geometric, p + lift_of(k, h, p, side));
    return s;
}

vvec three(const float (&p)[3]) {
    return load_broadcast_vec(at(p));
}

/// As sample_rectangle() of razor/kernels/light_samples.h.
LightRays light_rays(const LightSource& light, const Surface& s, const vint& sample) {
    vpoint on = sample_square(s.pixel, sample, light.dimension);
    vvec point = madd(on.v, three(light.edge_v), madd(on.u, three(light.edge_u), three(light.corner)));
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
    vfloat cos_light = -dot(three(light.normal), l.rays.direction);
    l.rays.active = s.hit & apart & (cos_surface > zero) & (cos_light > zero);
    l.weight = cos_surface * cos_light * (inverse * inverse);
    return l;
}

/// As sample_sky() there.
LightRays sky_rays(const Surface& s, const vint& sample) {
    vpoint on = sample_square(s.pixel, sample, dimension_sky);
    vfloat radius = sqrt(on.u);
    vfloat height = sqrt(vfloat(1.0F) - on.u);
    vfloat angle = on.v * 6.28318530717958647692F;
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = to_world(s.shading, radius * cos(angle), radius * sin(angle), height);
    vfloat zero(0.0F);
    l.rays.t_min = zero;
    l.rays.t_max = vfloat(infinite);
    l.rays.active = s.hit & (dot(s.geometric, l.rays.direction) > zero);
    l.weight = vfloat(1.0F);
    return l;
}

/// As gather_light() there: packets hold neighbouring hits, four samples of each. `sample` makes the rays of
/// samples by number.
template <class Sample>
vfloat gather_rays(const RenderArguments& a, const Surface& s, int samples, unsigned flags,
                   std::int64_t& rays, Sample sample) {
    constexpr int per_hit = 4, hits_per_packet = isa::width / per_hit;
    alignas(64) lanes sums = {};
    vint order = compress(lane_index(), s.hit);
    const int hits = count(s.hit).v;
    vint member = lane_index() & vint(per_hit - 1);
    vint rank = lane_index() >> 2;
    for (int from = 0; from < hits; from += hits_per_packet) {
        vint place = rank + vint(from);
        vmask present = place < vint(hits);
        vint lane = permute(order, place);
        Surface here;
        here.hit = present;
        here.position = permute(s.position, lane);
        here.geometric = permute(s.geometric, lane);
        here.shading = permute(s.shading, lane);
        here.pixel = permute(s.pixel, lane);
        for (int k = 0; k < samples; k += per_hit) {
            vint number = member + vint(k);
            LightRays l = sample(here, number);
            l.rays.active = l.rays.active & (number < vint(samples));
            if (!branch(any(l.rays.active)))
                continue;
            rays += count(l.rays.active).v;
            vmask arrives = find_open(a, l.rays, flags);
            vfloat part = select(arrives, l.weight, vfloat(0.0F));
            part = part + permute(part, lane_index() ^ vint(1));
            part = part + permute(part, lane_index() ^ vint(2));
            vmask leader = present & (member == vint(0));
            pointer<float> to(sums);
            scatter(to, lane, gather(to, lane, leader) + part, leader);
        }
    }
    return load_vector(at(sums));
}

struct Sums {
    vvec beauty, normal, albedo;
    vfloat depth, hits;
};

vvec reflected(const Surface& s, const vfloat& light, const float (&radiance)[3]) {
    vvec arriving = three(radiance) * light;
    return {arriving.x * s.albedo.x, arriving.y * s.albedo.y, arriving.z * s.albedo.z};
}

void add_sample(const RenderArguments& a, const Rays& r, const vint& pixel, int number, Sums& sums,
                RayCounts& counts) {
    const FrameView& view = *a.view;
    Found f = find_closest(a, r);
    vfloat zero(0.0F);
    vvec none_yet{zero, zero, zero};
    counts.camera += count(r.active).v;
    counts.hits += count(f.hit).v;
    sums.beauty = sums.beauty + select(r.active & !f.hit, three(view.background), none_yet);
    if (branch(none(f.hit)))
        return;
    Surface s = surface_of(a, r, f);
    s.pixel = pixel;
    sums.normal = sums.normal + select(f.hit, s.shading, none_yet);
    sums.albedo = sums.albedo + select(f.hit, s.albedo, none_yet);
    sums.depth = sums.depth + select(f.hit, f.t, zero);
    sums.hits = sums.hits + select(f.hit, vfloat(1.0F), zero);
    for (int i = 0; i < a.light_count && view.light_samples > 0; ++i) {
        const LightSource& light = a.lights[i];
        const vint first(number * view.light_samples);
        vfloat weight = gather_rays(
            a, s, view.light_samples, RTC_INTERSECT_CONTEXT_FLAG_NONE, counts.light,
            [&](const Surface& here, const vint& k) { return light_rays(light, here, k + first); });
        sums.beauty = sums.beauty + select(f.hit, reflected(s, weight, light.radiance), none_yet);
    }
    if (view.sky_samples > 0) {
        const vint first(number * view.sky_samples);
        vfloat weight =
            gather_rays(a, s, view.sky_samples, RTC_INTERSECT_CONTEXT_FLAG_NONE, counts.sky,
                        [&](const Surface& here, const vint& k) { return sky_rays(here, k + first); });
        sums.beauty = sums.beauty + select(f.hit, reflected(s, weight, view.sky), none_yet);
    }
}

/// As camera_rays() of razor/kernels/render.h.
Rays rays_from_camera(const FrameView& view, const vint& column, const vint& row, const vint& pixel,
                      int sample, const vmask& active) {
    vpoint on = sample_square(pixel, vint(sample), dimension_film);
    vfloat x = to_float(column) + on.u;
    vfloat y = to_float(row) + on.v;
    vvec d = madd(y, three(view.film_y), madd(x, three(view.film_x), three(view.film_corner)));
    Rays r;
    r.origin = three(view.camera);
    if (view.focus > 0) {
        vpoint lens = concentric_disk(sample_square(pixel, vint(sample), dimension_lens));
        vvec from = madd(lens.v, three(view.lens_y), three(view.lens_x) * lens.u);
        r.origin = r.origin + from;
        d = d * vfloat(view.focus) - from;
    }
    r.direction = d * reciprocal_sqrt(dot(d, d));
    r.t_min = vfloat(0.0F);
    r.t_max = vfloat(infinite);
    r.active = active;
    return r;
}

/// As resolve() there.
void put_pixels(const RenderArguments& a, const Sums& sums, const vint& pixel, const vmask& m) {
    vfloat share = reciprocal(vfloat(static_cast<float>(a.view->samples)));
    vfloat zero(0.0F);
    vmask hit = sums.hits > zero;
    vfloat depth = sums.depth / select(hit, sums.hits, vfloat(1.0F));
    depth = select(hit, depth, vfloat(infinity));
    vvec normal = normalise(sums.normal, {zero, zero, zero});
    vvec beauty = sums.beauty * share;
    vvec albedo = sums.albedo * share;
    const vfloat* planes[film_planes] = {&beauty.x, &beauty.y, &beauty.z, &normal.x, &normal.y,
                                         &normal.z, &depth,    &albedo.x, &albedo.y, &albedo.z};
    const std::size_t plane =
        static_cast<std::size_t>(a.view->width) * static_cast<std::size_t>(a.view->height);
    for (std::size_t k = 0; k < film_planes; ++k)
        scatter(pointer<float>(a.film + k * plane), pixel, *planes[k], m);
}

/// Packets are four pixels high, and each of Embree's sixteen rays a square of them.
void render_tile(const RenderArguments& a, int tile, RayCounts& counts) {
    const FrameView& view = *a.view;
    const int tiles_x = (view.width + tile_side - 1) / tile_side;
    const int x0 = tile % tiles_x * tile_side, y0 = tile / tiles_x * tile_side;
    const int x1 = std::min(x0 + tile_side, view.width), y1 = std::min(y0 + tile_side, view.height);
    vint lane_x = (lane_index() & vint(3)) + ((lane_index() >> 4) << 2);
    vint lane_y = (lane_index() >> 2) & vint(3);
    for (int y = y0; y < y1; y += 4)
        for (int x = x0; x < x1; x += 4 * packets) {
            vint column = lane_x + vint(x), row = lane_y + vint(y);
            vmask inside = (column < vint(x1)) & (row < vint(y1));
            vint pixel = row * vint(view.width) + column;
            vint place = pixel + vint(view.sample_seed);
            vfloat zero(0.0F);
            Sums sums{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero, zero};
            for (int s = 0; s < view.samples; ++s)
                add_sample(a, rays_from_camera(view, column, row, place, s, inside), place, s, sums, counts);
            put_pixels(a, sums, pixel, inside);
        }
}

#define RAZOR_NAME(target) #target
#define RAZOR_TARGET_NAME(target) RAZOR_NAME(target)

} // namespace

extern constinit const Kernels baseline_kernels = {RAZOR_TARGET_NAME(ISA_TARGET), tessellate, render_tile};

} // namespace razor::ISA_TARGET
