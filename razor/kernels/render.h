// The worker: refits with the others, then takes tiles from the queue, traces their camera packets, shades,
// and resolves into the film.
#pragma once

#include "razor/kernels/budget_tiles.h"
#include "razor/kernels/film_filter.h"
#include "razor/kernels/leave.h"
#include "razor/kernels/packet.h"
#include "razor/kernels/pixel_sums.h"
#include "razor/kernels/refit.h"
#include "razor/kernels/screen_curve.h"
#include "razor/kernels/stretches.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Which pixels and samples the lanes of a packet are: 2^samples_log2 samples of a pixel side by side, and
/// pixels as square as what is left of the width allows. Rays of one pixel meet the same few quads, so the
/// more of its samples come together the less is visited.
struct PacketShape {
    sint samples_log2, columns_log2, rows_log2;
};

inline PacketShape packet_shape(sint samples_log2) {
    constexpr int width_log2 = __builtin_ctz(isa::width);
    PacketShape s;
    s.samples_log2 = samples_log2;
    sint pixels_log2 = sint(width_log2) - s.samples_log2;
    s.rows_log2 = pixels_log2 >> 1;
    s.columns_log2 = pixels_log2 - s.rows_log2;
    return s;
}

/// Which samples of a tile's pixels are taken, and where their sums are kept (null: nowhere).
struct TileSamples {
    sint first, end, packet_log2;
    pointer<float> before, after;
};

inline TileSamples samples_of_tile(const Context& c, sint tile) {
    TileSamples t;
    t.first = load(field(c.frame, &FrameHeader::first_sample));
    sint samples = load(field(c.frame, &FrameHeader::samples));
    t.end = t.first + samples;
    t.packet_log2 = load(field(c.frame, &FrameHeader::packet_samples_log2));
    t.before = load(field(c.frame, &FrameHeader::sums_before));
    t.after = load(field(c.frame, &FrameHeader::sums_after));
    pointer<TilePass> passes = load(field(c.frame, &FrameHeader::tile_passes));
    if (branch(!is_null(passes))) {
        pointer<TilePass> own = passes + tile;
        t.first = load(field(own, &TilePass::first));
        t.end = load(field(own, &TilePass::end));
        t.packet_log2 = load(field(own, &TilePass::packet_samples_log2));
        sint swapped = load(field(own, &TilePass::swapped));
        if (branch(swapped != 0)) {
            pointer<float> before = t.before;
            t.before = t.after;
            t.after = before;
        }
    }
    return t;
}

struct Camera {
    vvec position, corner, x, y;
    vvec lens_x, lens_y; // radii of the lens
    vfloat focus;        // the depth in focus
    sbool lens;
    sbool parallel; // rays go along the line of sight
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
    sint orthographic = load(field(c.frame, &FrameHeader::orthographic));
    k.parallel = orthographic != 0;
    return k;
}

/// Rays through the pixels (column, row), one lane each, `at` from the pixel's corner.
inline Rays camera_rays(const Context& c, const Camera& k, const vint& column, const vint& row,
                        const vpoint& at, const vint& pixel, const vint& sample, const vmask& active) {
    vfloat x = to_float(column) + at.u;
    vfloat y = to_float(row) + at.v;
    vvec d = madd(y, k.y, madd(x, k.x, k.corner));
    Rays r;
    r.origin = k.position;
    if (branch(k.parallel)) {
        r.origin = r.origin + d;
        d = load_broadcast_vec(field(c.frame, &FrameHeader::line_of_sight));
    }
    if (branch(k.lens)) {
        vpoint on = concentric_disk(sample_square(pixel, sample, dimension_lens));
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

/// Of each lane's samples to those of its pixel.
inline void add_lanes(const PacketShape& shape, PixelSums& sums) {
    sint lanes = sint(1) << shape.samples_log2;
    for (sint k = 1; branch(k < lanes); k = k + k) {
        vint other = lane_index() ^ vint(k);
        sums.beauty = sums.beauty + permute(sums.beauty, other);
        sums.normal = sums.normal + permute(sums.normal, other);
        sums.albedo = sums.albedo + permute(sums.albedo, other);
        sums.depth = sums.depth + permute(sums.depth, other);
        sums.hits = sums.hits + permute(sums.hits, other);
    }
}
/// The same of what weighted sums have besides.
inline void add_weighted_lanes(const PacketShape& shape, WeightedSums& sums) {
    sint lanes = sint(1) << shape.samples_log2;
    for (sint k = 1; branch(k < lanes); k = k + k) {
        vint other = lane_index() ^ vint(k);
        sums.beauty = sums.beauty + permute(sums.beauty, other);
        sums.albedo = sums.albedo + permute(sums.albedo, other);
        sums.weight = sums.weight + permute(sums.weight, other);
    }
}

} // namespace shade_kernel

inline namespace resolve_kernel {

/// Adds what earlier passes left, and leaves the sum for the next; planes begin at `before` and `after`.
class KeptSums {
public:
    KeptSums(const Context& c, const TileSamples& taken, const vint& pixel, const vmask& m)
        : before_(taken.before), after_(taken.after), pixel_(pixel), m_(m) {
        sint width = load(field(c.frame, &FrameHeader::width));
        sint height = load(field(c.frame, &FrameHeader::height));
        plane_ = width * height;
        later_ = taken.first > 0;
    }
    void keep(PixelSums& sums) {
        keep_vector(sums.beauty);
        keep_vector(sums.normal);
        keep_vector(sums.albedo);
        keep_plane(sums.depth);
        keep_plane(sums.hits);
    }
    void keep_weighted(WeightedSums& sums) {
        keep(sums.even);
        keep_vector(sums.beauty);
        keep_vector(sums.albedo);
        keep_plane(sums.weight);
    }

private:
    [[gnu::noinline]] void keep_plane(vfloat& sum) {
        if (branch(later_)) {
            vfloat before = gather(before_, pixel_, m_);
            sum = sum + before;
        }
        scatter(after_, pixel_, sum, m_);
        before_ = before_ + plane_;
        after_ = after_ + plane_;
    }
    void keep_vector(vvec& sum) {
        keep_plane(sum.x);
        keep_plane(sum.y);
        keep_plane(sum.z);
    }

    pointer<float> before_, after_;
    vint pixel_;
    vmask m_;
    sint plane_ = 0;
    sbool later_;
};

[[gnu::noinline]] inline void keep_sums(const Context& c, const TileSamples& taken, const vint& pixel,
                                        const vmask& m, PixelSums& sums) {
    phase_scope phase(phase_resolve);
    KeptSums kept(c, taken, pixel, m);
    kept.keep(sums);
}
/// What stands for the pixels' sums, `sums` being those of samples that all count alike.
[[gnu::noinline]] inline void finish_weighted(const Context& c, const PacketShape& shape,
                                              const TileSamples& taken, const vint& pixel, const vmask& m,
                                              WeightedSums& weighted, PixelSums& sums) {
    phase_scope phase(phase_resolve);
    weighted.even = sums;
    add_weighted_lanes(shape, weighted);
    if (branch(!is_null(taken.after))) {
        KeptSums kept(c, taken, pixel, m);
        kept.keep_weighted(weighted);
    }
    sums = sums_of(weighted, taken.end);
}

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

/// Sampler::add<F>(c, rays, pixel, sample, sums) traces a packet's camera rays and adds what they see.
template <Features F, class Sampler> [[gnu::noinline]] inline void render_tile(const Context& c, sint tile) {
    phase_scope phase(phase_shade);
    TileSamples taken = samples_of_tile(c, tile);
    if (branch(taken.first == taken.end))
        return;
    sint width = load(field(c.frame, &FrameHeader::width));
    sint height = load(field(c.frame, &FrameHeader::height));
    sint tiles_x = load(field(c.frame, &FrameHeader::tiles_x));
    sint tiles_y = load(field(c.frame, &FrameHeader::tiles_y));
    Camera camera = load_camera(c);
    forget_fields(c); // so that it does not matter which tiles a worker had before
    sint in_rows = load(field(c.frame, &FrameHeader::tile_rows));
    TilePlace corner =
        branch(in_rows != 0) ? place_in_rows(tiles_x, tile) : place_on_curve(tiles_x, tiles_y, tile);
    sint tile_column = corner.column + load(field(c.frame, &FrameHeader::first_column));
    sint tile_row = corner.row + load(field(c.frame, &FrameHeader::first_row));
    sint x0 = tile_column * tile_side;
    sint y0 = tile_row * tile_side;
    sint x1 = min(x0 + tile_side, width);
    sint y1 = min(y0 + tile_side, height);
    sint seed = load(field(c.frame, &FrameHeader::sample_seed));
    sint filter = load(field(c.frame, &FrameHeader::filter_use));
    sbool filtered = filter != filter_pixel;
    sbool weighted = filter == filter_weighted;
    sbool passes = !is_null(taken.after);
    PacketShape shape = packet_shape(taken.packet_log2);
    sint packet_samples = sint(1) << shape.samples_log2;
    sint columns = sint(1) << shape.columns_log2;
    sint rows = sint(1) << shape.rows_log2;
    vint member = lane_index() & vint(packet_samples - 1);
    vint place_in = lane_index() >> vint(shape.samples_log2);
    vint lane_x = place_in & vint(columns - 1);
    vint lane_y = place_in >> vint(shape.columns_log2);
    for (sint y = y0; branch(y < y1); y += rows) {
        for (sint x = x0; branch(x < x1); x += columns) {
            vint column = lane_x + vint(x);
            vint row = lane_y + vint(y);
            vmask inside = column < vint(x1);
            inside = inside & (row < vint(y1));
            vint pixel = row * vint(width);
            pixel = pixel + column;
            owner_scope owners(pixel, inside);
            vint place = pixel + vint(seed);
            PixelSums sums = no_sums();
            WeightedSums weighted_sums;
            if (branch(weighted))
                weighted_sums = no_weighted_sums();
            for (sint s = taken.first; branch(s < taken.end); s += packet_samples) {
                vint sample = member + vint(s);
                vpoint square = sample_square(place, sample, dimension_film);
                vpoint at = square;
                if (branch(filtered))
                    at = draw_filtered(c, square, inside);
                Rays r = camera_rays(c, camera, column, row, at, place, sample, inside);
                Sampler::template add<F>(c, r, place, sample, sums);
                if (branch(weighted))
                    add_weighted(c, square, inside, sums, weighted_sums);
                note_time(*c.watch, moment_first_packet);
            }
            vmask one = inside & (member == vint(0));
            if (branch(weighted))
                sums = weighted_sums.even;
            add_lanes(shape, sums);
            if (branch(weighted))
                finish_weighted(c, shape, taken, pixel, one, weighted_sums, sums);
            else if (branch(passes))
                keep_sums(c, taken, pixel, one, sums);
            resolve(c, sums, pixel, taken.end, one);
        }
    }
}

/// Renders the run's tiles; false: the workers are to stop.
template <Features F, class Sampler> inline bool render_run(const Context& c, const Run& run) {
    pointer<QueueRecord> queues = load(field(c.frame, &FrameHeader::queues));
    Run tiles = tiles_of(c, run);
    for (sint tile = tiles.first; branch(tile < tiles.end); ++tile) {
        sint stopped = load_acquire(field(queues, &QueueRecord::stopped));
        if (branch(stopped != 0))
            return false;
        begin_lap(*c.tiles);
        render_within_budget(c, [&](const Context& within) { render_tile<F, Sampler>(within, tile); });
        end_lap(*c.tiles, tile);
    }
    return true;
}

/// Of a worker's own tiles so many at least are left to it and to thieves, whoever waits: what is begun in
/// place of a wait delays the tile that waits.
inline constexpr int meanwhile_least = 4;

/// Renders other tiles in place of a wait, in scratch memory of their own; false: there are none. While these
/// wait, nothing else is begun.
template <Features F, class Sampler> [[gnu::noinline]] inline bool render_meanwhile(const Context& outer) {
    Run run = take_back(outer, meanwhile_least);
    if (branch(run.first == run.end))
        return false;
    kind_scope kind(kind_none);
    Context c = outer;
    c.other_work = nullptr;
    c.counters = c.by_kind;
    c.stack = c.stack + spare_stack;
    c.packets = c.packets + spare_packets;
    if (branch(!is_null(c.cuts)))
        c.cuts = c.cuts + light_cut_floats;
    tally(c.counters->meanwhile_runs, 1);
    render_run<F, Sampler>(c, run);
    return true;
}

template <Features F, class Sampler> inline void render_worker(const Context& c) {
    refit(c);
    clear_blends(c);
    for (;;) {
        Run run = take_run(c);
        if (branch(run.first == run.end))
            break;
        if (!render_run<F, Sampler>(c, run))
            return;
    }
    if (branch(c.discards))
        discard_all(c);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
