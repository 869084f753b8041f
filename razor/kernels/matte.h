// Camera samples where everything is matte: closest hits and the light that they receive.
#pragma once

#include "razor/kernels/light.h"
#include "razor/kernels/mapped.h"
#include "razor/kernels/pixel_sums.h"

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
    sums.beauty = sums.beauty + select(open, sky, {zero, zero, zero});
    if (branch(none(hit)))
        return;
    Beyond beyond;
    Surface s = find_surface < Mapped ? look_mapped : look_matte > (c, r, h, beyond);
    s.pixel = pixel;
    s.sample = sample;
    if constexpr (Mapped) {
        Materials of = materials_of(c, beyond, hit);
        vvec own = of.colour(&MaterialRecord::albedo);
        s.albedo = times(own, of.mapped(c, map_albedo, beyond.map));
        bend_normals(c, beyond, s);
    }
    sums.normal = sums.normal + select(hit, s.shading, {zero, zero, zero});
    sums.albedo = sums.albedo + select(hit, s.albedo, {zero, zero, zero});
    sums.depth = sums.depth + select(hit, h.t, zero);
    sums.hits = sums.hits + select(hit, vfloat(1.0F), zero);
    const auto reflect = [&](const vvec& radiance, const Gathered<Matte>& light) {
        vvec arriving = radiance * light.lobe[0];
        vvec reflected{arriving.x * s.albedo.x, arriving.y * s.albedo.y, arriving.z * s.albedo.z};
        sums.beauty = sums.beauty + select(hit, reflected, {zero, zero, zero});
    };
    sint lights = load(field(c.frame, &FrameHeader::light_count));
    pointer<LightRecord> light = load(field(c.frame, &FrameHeader::lights));
    for (sint n = 0; branch(n < lights); ++n) {
        sint samples = load(field(light, &LightRecord::samples));
        Gathered<Matte> gathered = gather_light<F, Mapped>(c, s, light, Matte{}, samples);
        reflect(load_broadcast_vec(field(light, &LightRecord::radiance)), gathered);
        light = light + 1;
    }
    sint sky_samples = load(field(c.frame, &FrameHeader::sky_samples));
    if (branch(sky_samples > 0)) {
        Gathered<Matte> gathered = gather_light<F, Mapped>(c, s, TowardsSky{}, Matte{}, sky_samples);
        reflect(load_broadcast_vec(field(c.frame, &FrameHeader::sky)), gathered);
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
