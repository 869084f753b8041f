// The worker: refits with the others, then takes tiles from the queue, traces their camera packets, shades,
// and resolves into the film.
#pragma once

#include "razor/kernels/budget_tiles.h"
#include "razor/kernels/refit.h"
#include "razor/kernels/shade.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Pixels of a packet: as square as the width allows.
inline constexpr int packet_width = isa::width >= 32 ? 8 : 4;
inline constexpr int packet_height = isa::width / packet_width;

struct Camera {
    vvec position, corner, x, y;
    vvec lens_x, lens_y; // radii of the lens
    vfloat focus;        // the depth in focus
    sbool lens;
};

inline Camera load_camera(const Context& c) {
    Camera k;
    k.position = load_broadcast_vec(field(c.frame, &FrameHeader::camera));
    k.corner = load_broadcast_vec(field(c.frame, &FrameHeader::film_corner));
    k.x = load_broadcast_vec(field(c.frame, &FrameHeader::film_x));
    k.y = load_broadcast_vec(field(c.frame, &FrameHeader::film_y));
    k.lens_x = load_broadcast_vec(field(c.frame, &FrameHeader::lens_x));
    k.lens_y = load_broadcast_vec(field(c.frame, &FrameHeader::lens_y));
    sfloat focus = load(field(c.frame, &FrameHeader::focus));
    k.focus = vfloat(focus);
    k.lens = focus > 0.0F;
    return k;
}

/// Rays through the pixels (column, row), one lane each, at this sample's place in the pixel.
inline Rays camera_rays(const Context& c, const Camera& k, const vint& column, const vint& row,
                        const vint& pixel, sint sample, const vmask& active) {
    vpoint at = sample_square(pixel, vint(sample), dimension_film);
    vfloat x = to_float(column) + at.u;
    vfloat y = to_float(row) + at.v;
    vvec d = madd(y, k.y, madd(x, k.x, k.corner));
    Rays r;
    r.origin = k.position;
    if (branch(k.lens)) {
        vpoint on = concentric_disk(sample_square(pixel, vint(sample), dimension_lens));
        vvec from = madd(on.v, k.lens_y, k.lens_x * on.u);
        r.origin = r.origin + from;
        d = d * k.focus - from;
    }
    r.direction = d * reciprocal_sqrt(dot(d, d));
    r.t_min = vfloat(0.0F);
    r.t_max = vfloat(infinite);
    r.active = active;
    ask_for_camera(c, r);
    return r;
}

/// Sums over the samples of one packet of pixels.
struct PixelSums {
    vvec beauty, normal, albedo;
    vfloat depth, hits;
};

template <Features F>
inline void add_sample(const Context& c, const Rays& r, const vint& pixel, sint sample, PixelSums& sums) {
    Hits h = trace_packet<F, kind_camera>(c, r);
    vfloat zero(0.0F);
    vmask hit = h.patch >= vint(0);
    tally(c.counters->camera_hits, count(hit));
    vvec sky = load_broadcast_vec(field(c.frame, &FrameHeader::background));
    vmask open = r.active & !hit;
    sums.beauty = sums.beauty + select(open, sky, {zero, zero, zero});
    if (branch(none(hit)))
        return;
    Surface s = find_surface(c, r, h);
    s.pixel = pixel;
    sums.normal = sums.normal + select(hit, s.shading, {zero, zero, zero});
    sums.albedo = sums.albedo + select(hit, s.albedo, {zero, zero, zero});
    sums.depth = sums.depth + select(hit, h.t, zero);
    sums.hits = sums.hits + select(hit, vfloat(1.0F), zero);
    sint light_samples = load(field(c.frame, &FrameHeader::light_samples));
    if (branch(light_samples > 0)) {
        vfloat light = gather_light<F, false>(c, s, light_samples, sample * light_samples);
        vvec radiance = load_broadcast_vec(field(c.frame, &FrameHeader::light_radiance));
        vvec arriving = radiance * light;
        vvec reflected{arriving.x * s.albedo.x, arriving.y * s.albedo.y, arriving.z * s.albedo.z};
        sums.beauty = sums.beauty + select(hit, reflected, {zero, zero, zero});
    }
    sint sky_samples = load(field(c.frame, &FrameHeader::sky_samples));
    if (branch(sky_samples > 0)) {
        vfloat light = gather_light<F, true>(c, s, sky_samples, sample * sky_samples);
        vvec radiance = load_broadcast_vec(field(c.frame, &FrameHeader::sky));
        vvec arriving = radiance * light;
        vvec reflected{arriving.x * s.albedo.x, arriving.y * s.albedo.y, arriving.z * s.albedo.z};
        sums.beauty = sums.beauty + select(hit, reflected, {zero, zero, zero});
    }
}

} // namespace shade_kernel

inline namespace resolve_kernel {

/// Means of the samples into the film. Pixels without a hit have infinite depth and a zero normal.
[[gnu::noinline]] inline void resolve(const Context& c, const PixelSums& sums, const vint& pixel,
                                      sint samples, const vmask& m) {
    phase_scope phase(phase_resolve);
    pointer<float> film = load(field(c.frame, &FrameHeader::film));
    sint width = load(field(c.frame, &FrameHeader::width));
    sint height = load(field(c.frame, &FrameHeader::height));
    sint plane = width * height;
    vfloat share = reciprocal(vfloat(to_float(samples)));
    vmask hit = sums.hits > vfloat(0.0F);
    vfloat depth = sums.depth / select(hit, sums.hits, vfloat(1.0F));
    depth = select(hit, depth, vfloat(infinity));
    vfloat zero(0.0F);
    vvec normal = normalise(sums.normal, {zero, zero, zero});
    vvec beauty = sums.beauty * share;
    vvec albedo = sums.albedo * share;
    const auto put = [&](const vfloat& value) {
        scatter(film, pixel, value, m);
        film = film + plane;
    };
    const auto put_vector = [&](const vvec& value) {
        put(value.x);
        put(value.y);
        put(value.z);
    };
    put_vector(beauty);
    put_vector(normal);
    put(depth);
    put_vector(albedo);
}

} // namespace resolve_kernel

inline namespace shade_kernel {

template <Features F> [[gnu::noinline]] inline void render_tile(const Context& c, sint tile) {
    phase_scope phase(phase_shade);
    sint width = load(field(c.frame, &FrameHeader::width));
    sint height = load(field(c.frame, &FrameHeader::height));
    sint samples = load(field(c.frame, &FrameHeader::samples));
    sint tiles_x = load(field(c.frame, &FrameHeader::tiles_x));
    Camera camera = load_camera(c);
    forget_fields(c); // so that it does not matter which tiles a worker had before
    vfloat exact = to_float(vint(tile)) + 0.5F;
    exact = exact / to_float(vint(tiles_x));
    sint tile_row = extract(to_int(exact), 0);
    sint tile_column = tile - tile_row * tiles_x;
    sint x0 = tile_column * tile_side;
    sint y0 = tile_row * tile_side;
    sint x1 = min(x0 + tile_side, width);
    sint y1 = min(y0 + tile_side, height);
    sint seed = load(field(c.frame, &FrameHeader::sample_seed));
    vint lane_x = lane_index() & vint(packet_width - 1);
    vint lane_y = lane_index() >> (packet_width == 8 ? 3 : 2);
    for (sint y = y0; branch(y < y1); y += packet_height) {
        for (sint x = x0; branch(x < x1); x += packet_width) {
            vint column = lane_x + vint(x);
            vint row = lane_y + vint(y);
            vmask inside = column < vint(x1);
            inside = inside & (row < vint(y1));
            vint pixel = row * vint(width);
            pixel = pixel + column;
            vint place = pixel + vint(seed);
            vfloat zero(0.0F);
            PixelSums sums{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero, zero};
            for (sint s = 0; branch(s < samples); ++s) {
                Rays r = camera_rays(c, camera, column, row, place, s, inside);
                add_sample<F>(c, r, place, s, sums);
                note_time(*c.watch, moment_first_packet);
            }
            resolve(c, sums, pixel, samples, inside);
        }
    }
}

template <Features F> inline void render_worker(const Context& c) {
    refit(c);
    clear_blends(c);
    pointer<QueueRecord> queues = load(field(c.frame, &FrameHeader::queues));
    sint end = load(field(c.frame, &FrameHeader::tiles_end));
    sint tile = fetch_add(field(queues, &QueueRecord::next_tile), 1);
    while (branch(tile < end)) {
        begin_lap(*c.tiles);
        render_within_budget(c, [&](const Context& within) { render_tile<F>(within, tile); });
        end_lap(*c.tiles, tile);
        tile = fetch_add(field(queues, &QueueRecord::next_tile), 1);
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
