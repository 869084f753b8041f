// Camera samples where everything is matte: closest hits and the light that they receive.
#pragma once

#include "razor/kernels/chosen_lights.h"
#include "razor/kernels/light.h"
#include "razor/kernels/pixel_sums.h"
#include "razor/kernels/shade.h"
#include "razor/kernels/sky_map.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Mapped: with textures and materials of faces.
template <bool Mapped> struct MatteSampler {
    template <Features F>
    static void add(const Context& c, const Rays& r, const vint& pixel, const vint& sample, PixelSums& sums);
};

template <bool Mapped>
template <Features F>
inline void MatteSampler<Mapped>::add(const Context& c, const Rays& r, const vint& pixel, const vint& sample,
                                      PixelSums& sums) {
    Hits h = trace_seen<F, kind_camera, Mapped>(c, r);
    vfloat zero(0.0F);
    vmask hit = h.patch >= vint(0);
    tally(c.counters->camera_hits, count(hit));
    vvec sky = load_broadcast_vec(field(c.frame, &FrameHeader::background));
    vmask open = r.active & !hit;
    if constexpr (Mapped) {
        pointer<SkyRecord> map = load(field(c.frame, &FrameHeader::sky_map));
        if (branch(!is_null(map)))
            sky = see_mapped_sky(c, map, r, vfloat(delta_density), sint(0), open);
    }
    sums.beauty = sums.beauty + select(open, sky, {zero, zero, zero});
    if (branch(none(hit)))
        return;
    Beyond beyond;
    Surface s = find_surface < Mapped ? look_mapped : look_matte > (c, r, h, true, beyond);
    s.pixel = pixel;
    s.sample = sample;
    if constexpr (Mapped) {
        Materials of = materials_of(c, beyond.material, hit);
        count_evaluations(c, of, beyond.known);
        s.albedo = mapped_colour_of(c, of, &MaterialRecord::albedo, map_albedo, beyond.map, beyond.known);
        bend_normals(c, of, beyond, s);
    }
    sums.normal = sums.normal + select(hit, s.shading, {zero, zero, zero});
    sums.albedo = sums.albedo + select(hit, s.albedo, {zero, zero, zero});
    sums.depth = sums.depth + select(hit, h.t, zero);
    sums.hits = sums.hits + select(hit, vfloat(1.0F), zero);
    const auto add_reflected = [&](const vvec& reflected) {
        sums.beauty = sums.beauty + select(hit, reflected, {zero, zero, zero});
    };
    const auto reflect = [&](const vvec& arriving) { add_reflected(times(arriving, s.albedo)); };
    sint lights = load(field(c.frame, &FrameHeader::light_count));
    pointer<LightRecord> light = load(field(c.frame, &FrameHeader::lights));
    for (sint n = 0; branch(n < lights); ++n) {
        sint samples = load(field(light, &LightRecord::samples));
        Gathered<Matte> gathered = gather_light<F, Mapped>(c, s, light, Matte{}, samples);
        vvec radiance = load_broadcast_vec(field(light, &LightRecord::radiance));
        reflect(radiance * gathered.lobe[0]);
        light = light + 1;
    }
    sint choices = load(field(c.frame, &FrameHeader::light_choices));
    if (branch(choices > 0)) {
        reflect(gather_chosen<F, Mapped>(c, s, Matte{}, choices).of(0));
    }
    sint sky_samples = load(field(c.frame, &FrameHeader::sky_samples));
    if (branch(sky_samples > 0)) {
        vvec radiance = load_broadcast_vec(field(c.frame, &FrameHeader::sky));
        if constexpr (Mapped) {
            pointer<SkyRecord> map = load(field(c.frame, &FrameHeader::sky_map));
            if (branch(!is_null(map))) {
                vvec arriving = gather_mapped_sky<F>(c, map, s, Matte{}, sky_samples).of(0);
                add_reflected(times(times(arriving, s.albedo), radiance)); // in PathSampler's order
                return;
            }
        }
        Gathered<Matte> gathered = gather_light<F, Mapped>(c, s, TowardsSky{}, Matte{}, sky_samples);
        reflect(radiance * gathered.lobe[0]);
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
