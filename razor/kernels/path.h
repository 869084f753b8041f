// Camera samples where surfaces reflect, let through and emit: paths of light, followed backwards. At each
// hit lights are sampled, and one direction of one lobe is followed; both share what either could find by
// multiple importance sampling (Veach 1997, chapter 9), lobe by lobe.
#pragma once

#include "razor/kernels/chosen_lights.h"
#include "razor/kernels/light.h"
#include "razor/kernels/pixel_sums.h"
#include "razor/kernels/seen_lights.h"
#include "razor/kernels/sky_map.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// What the lobes make of light of that colour. In the order of operations that matte surfaces have where all
/// other lobes are nothing: then it is the same, to the last bit.
template <class Response>
inline vvec coloured(const Gathered<Response>& light, const vvec& radiance, const Response& g,
                     const Colours& colours) {
    vvec diffuse = times(radiance * light.lobe[lobe_diffuse], colours.diffuse);
    vfloat grazing = light.lobe[lobe_grazing] * colours.grazing;
    vfloat white = grazing + light.lobe[lobe_coat];
    vvec bright = madd(light.lobe[lobe_normal], colours.normal, {white, white, white});
    vvec all = diffuse + times(radiance, bright);
    if constexpr (Response::lobes > Glossy::lobes)
        all = all + times(radiance * light.lobe[lobe_sheen], g.sheen);
    return all;
}

/// The same of light of many colours.
template <class Response>
inline vvec coloured(const GatheredColours<Response>& light, const Response& g, const Colours& colours) {
    vvec diffuse = times(light.of(lobe_diffuse), colours.diffuse);
    vvec white = light.of(lobe_coat);
    vvec grazing = light.of(lobe_grazing);
    white = madd(colours.grazing, grazing, white);
    vvec normal = times(light.of(lobe_normal), colours.normal);
    vvec all = diffuse + (normal + white);
    if constexpr (Response::lobes > Glossy::lobes)
        all = all + times(light.of(lobe_sheen), g.sheen);
    return all;
}

/// Adds all light that reaches the hit and is reflected towards the viewer, who gets `carried` of it.
/// `fewer`: one shadow ray to each light.
template <Features F, bool Mapped, class Response>
inline void add_light(const Context& c, const Surface& s, const Response& g, const Colours& colours,
                      const vvec& carried, sbool fewer, vvec& beauty) {
    vfloat zero(0.0F);
    const auto add = [&](const Gathered<Response>& gathered, const vvec& radiance, sint stated, sint taken) {
        sfloat number = to_float(taken);
        vvec arriving = radiance * vfloat(to_float(stated) / number);
        vvec seen = times(coloured(gathered, arriving, g, colours), carried);
        beauty = beauty + select(s.hit, seen, {zero, zero, zero});
    };
    sint lights = load(field(c.frame, &FrameHeader::light_count));
    pointer<LightRecord> light = load(field(c.frame, &FrameHeader::lights));
    for (sint n = 0; branch(n < lights); ++n) {
        sint stated = load(field(light, &LightRecord::samples));
        sint taken = select(fewer, sint(1), stated);
        Gathered<Response> gathered = gather_light<F, Mapped>(c, s, light, g, taken);
        add(gathered, load_broadcast_vec(field(light, &LightRecord::radiance)), stated, taken);
        light = light + 1;
    }
    sint choices = load(field(c.frame, &FrameHeader::light_choices));
    if (branch(choices > 0)) {
        sint few = parts_after_bounces(choices);
        sint parts = select(fewer, few, choices);
        GatheredColours<Response> gathered = gather_chosen<F, Mapped>(c, s, g, parts);
        vvec seen = times(coloured(gathered, g, colours), carried);
        beauty = beauty + select(s.hit, seen, {zero, zero, zero});
    }
    sint emitters = load(field(c.frame, &FrameHeader::emitter_count));
    if (branch(emitters > 0)) {
        sint all = load(field(c.frame, &FrameHeader::emitter_samples));
        sint taken = select(fewer, sint(1), all);
        GatheredColours<Response> gathered = gather_emitters<F, Mapped>(c, s, g, taken);
        vvec seen = times(coloured(gathered, g, colours), carried);
        beauty = beauty + select(s.hit, seen, {zero, zero, zero});
    }
    sint sky_samples = load(field(c.frame, &FrameHeader::sky_samples));
    if (branch(sky_samples > 0)) {
        sint taken = select(fewer, sint(1), sky_samples);
        if constexpr (Mapped) {
            pointer<SkyRecord> map = load(field(c.frame, &FrameHeader::sky_map));
            if (branch(!is_null(map))) {
                GatheredColours<Response> gathered = gather_mapped_sky<F>(c, map, s, g, taken);
                vvec radiance = load_broadcast_vec(field(c.frame, &FrameHeader::sky));
                sfloat number = to_float(taken);
                radiance = radiance * vfloat(to_float(sky_samples) / number);
                vvec seen = times(times(coloured(gathered, g, colours), radiance), carried);
                beauty = beauty + select(s.hit, seen, {zero, zero, zero});
                return;
            }
        }
        Gathered<Response> gathered = gather_light<F, Mapped>(c, s, TowardsSky{}, g, taken);
        add(gathered, load_broadcast_vec(field(c.frame, &FrameHeader::sky)), sky_samples, taken);
    }
}

/// Added to the numbers of pixels at each bounce, so that its samples have nothing to do with those before.
inline constexpr std::uint32_t bounce_step = 0x85ebca6bU;

/// The path's first hits as they are seen in other layers than beauty.
inline void note_first(const Surface& s, const Hits& h, const vvec& albedo, PixelSums& sums) {
    vfloat zero(0.0F);
    sums.normal = sums.normal + select(s.hit, s.shading, {zero, zero, zero});
    sums.albedo = sums.albedo + select(s.hit, albedo, {zero, zero, zero});
    sums.depth = sums.depth + select(s.hit, h.t, zero);
    sums.hits = sums.hits + select(s.hit, vfloat(1.0F), zero);
}

/// Mapped: with textures and materials of faces.
template <bool Mapped> struct PathSampler {
    template <Features F>
    static void add(const Context& c, const Rays& r, const vint& pixel, const vint& sample, PixelSums& sums);
};

template <bool Mapped>
template <Features F>
inline void PathSampler<Mapped>::add(const Context& c, const Rays& camera, const vint& pixel,
                                     const vint& sample, PixelSums& sums) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vvec black{zero, zero, zero};
    vvec background = load_broadcast_vec(field(c.frame, &FrameHeader::background));
    sint bounces = load(field(c.frame, &FrameHeader::bounces));
    sint diffuse_bounces = load(field(c.frame, &FrameHeader::diffuse_bounces));
    sint emitters = load(field(c.frame, &FrameHeader::emitter_count));
    sint choices = load(field(c.frame, &FrameHeader::light_choices));
    sint sheens = load(field(c.frame, &FrameHeader::sheens));
    vvec carried{one, one, one};
    sbool chosen = choices > 0;
    chosen = chosen | (emitters > 0);
    Surface before; // where bounces left, if lights are chosen
    Bounce bounce;
    bounce.rays = camera;
    bounce.density = vfloat(delta_density);
    bounce.diffuse = vmask(false);
    for (sint n = 0; branch(n <= bounces); ++n) {
        const Rays& r = bounce.rays;
        Hits h;
        vvec found = background;
        if (branch(n == 0)) {
            h = trace_seen<F, kind_camera, Mapped>(c, r);
            tally(c.counters->camera_hits, count(h.patch >= vint(0)));
        } else {
            h = trace_seen<F, kind_bounce, Mapped>(c, r);
            tally(c.counters->bounce_hits, count(h.patch >= vint(0)));
            found = select(bounce.diffuse, black, background);
        }
        vmask hit = r.active & (h.patch >= vint(0));
        vmask open = r.active & !hit;
        found = select(open, found, black);
        if constexpr (Mapped) {
            pointer<SkyRecord> map = load(field(c.frame, &FrameHeader::sky_map));
            if (branch(!is_null(map))) {
                sint stated = load(field(c.frame, &FrameHeader::sky_samples));
                sint fewer = min(stated, sint(1));
                sint taken = select(n > 1, fewer, stated);
                vmask unseen = bounce.diffuse & vmask(stated == 0);
                vmask sees = open & !unseen;
                found = select(sees, see_mapped_sky(c, map, r, bounce.density, taken, sees), black);
            }
        }
        if (branch(n > 0)) {
            vfloat end = select(hit, h.t, vfloat(infinite));
            vvec met = meet_lights(c, r, end, bounce.density, n > 1);
            if (branch(choices > 0)) {
                sint few = parts_after_bounces(choices);
                sint parts = select(n > 1, few, choices);
                met = met + meet_chosen(c, r, end, bounce.density, before, parts);
            }
            found = found + met;
        }
        sums.beauty = sums.beauty + times(found, carried);
        if (branch(none(hit)))
            return;
        Beyond beyond;
        Surface s = find_surface < Mapped ? look_glossy_mapped : look_glossy > (c, r, h, n == 0, beyond);
        s.hit = hit;
        s.pixel = pixel + vint(n * std::int32_t(bounce_step));
        s.sample = sample;
        if constexpr (Mapped)
            bend_normals(c, materials_of(c, beyond.material, hit), beyond, s);
        Fibres fibres;
        if (branch(sheens != sheen_none)) {
            fibres = find_fibres<Mapped>(c, s, beyond, sheens);
            face_sheen(fibres, beyond, s);
        }
        Onward onward{n < bounces, n < diffuse_bounces};
        Colours colours;
        Glossy g = find_lobes<Mapped>(c, s, beyond, onward, colours);
        if (branch(n == 0))
            note_first(s, h, colours.albedo, sums);
        vvec emitted = times(colours.emission, carried);
        sbool met = emitters > 0;
        met = met & (n > 0);
        if (branch(met))
            emitted = emitted * left_of_emitters(c, s, beyond, h, bounce, before, n > 1);
        sums.beauty = sums.beauty + select(hit, emitted, black);
        if (branch(chosen))
            before = s;
        const auto go_on = [&](const auto& response) {
            add_light<F, Mapped>(c, s, response, colours, carried, n > 0, sums.beauty);
            if (branch(n < bounces))
                bounce = sample_bounce(c, s, beyond, response, colours, onward);
        };
        if (branch(sheens == sheen_none)) {
            go_on(g);
        } else {
            bool done = false;
            if constexpr (Mapped) {
                done = branch(sheens == sheen_rows);
                if (done)
                    go_on(cover(c, s, fibres, fibres.rows, g, colours, onward));
            }
            if (!done)
                go_on(cover(c, s, fibres, fibres.row, g, colours, onward));
        }
        if (branch(n == bounces))
            return;
        carried = select(bounce.rays.active, times(carried, bounce.carried), black);
        if (branch(none(bounce.rays.active)))
            return;
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
