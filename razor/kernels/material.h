// What hits are made of, as lobes.
#pragma once

#include "razor/kernels/glossy.h"
#include "razor/kernels/shade.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// The colours of a hit's lobes, and what it emits.
struct Colours {
    vvec albedo;  // as the material states it
    vvec diffuse; // of light that goes in all directions
    vvec normal;  // of the base at normal incidence
    vfloat grazing;
    vvec through; // of what is let through ...
    vfloat ior;   // ... and how that is bent
    vvec emission;
};

/// Shading normals that look away from the viewer are turned until they just do not.
inline vvec facing(const vvec& shading, const vvec& toward) {
    constexpr float least = 1.0e-3F;
    vfloat lack = vfloat(least) - dot(shading, toward);
    return normalise(madd(max(lack, 0.0F), toward, shading), toward);
}

/// What is done about light that bounces: whether anything, and whether also what is reflected in all
/// directions.
struct Onward {
    sbool at_all, diffuse;
};

/// Of the surface hit. Where something reflects, its shading normal is turned to face the viewer.
template <bool Mapped>
inline Glossy find_lobes(const Context& c, Surface& s, const Beyond& b, const Onward& onward,
                         Colours& colours) {
    Materials of = materials_of(c, b.material, s.hit);
    vfloat metallic, roughness;
    if constexpr (Mapped) {
        count_evaluations(c, of, b.known);
        colours.albedo = mapped_colour_of(c, of, &MaterialRecord::albedo, map_albedo, b.map, b.known);
        colours.emission = mapped_colour_of(c, of, &MaterialRecord::emission, map_emission, b.map, b.known);
        metallic = mapped_metallic(c, of, b.map, b.known);
        roughness = mapped_roughness(c, of, b.map, b.known);
    } else {
        colours.albedo = of.colour(&MaterialRecord::albedo);
        colours.emission = of.colour(&MaterialRecord::emission);
        metallic = of.number(&MaterialRecord::metallic);
        roughness = of.number(&MaterialRecord::roughness);
    }
    vfloat specular = of.number(&MaterialRecord::specular);
    vfloat reflection = of.number(&MaterialRecord::normal_reflection);
    vfloat ior = of.number(&MaterialRecord::ior);
    vfloat transmission = of.number(&MaterialRecord::transmission);
    vfloat coat = of.number(&MaterialRecord::coat);
    vfloat coat_roughness = of.number(&MaterialRecord::coat_roughness);
    vfloat one(1.0F);
    vfloat zero(0.0F);
    vfloat most = max(metallic, specular);
    most = max(most, transmission);
    vmask matte = max(most, coat) <= zero;
    s.shading = select(matte, s.shading, facing(s.shading, b.toward));
    Glossy g;
    g.toward = b.toward;
    g.view = max(dot(s.shading, b.toward), 1.0e-4F);
    g.alpha = roughness * roughness;
    g.base_norm = slope_norm(g.view, g.alpha);
    g.coat_alpha = coat_roughness * coat_roughness;
    g.coat_norm = slope_norm(g.view, g.coat_alpha);
    g.specular = specular;
    g.dielectric = specular * reflection;
    g.coat = coat;
    vfloat entering = vfloat(28.0F / 23.0F) * (one - reflection);
    g.below = below_at(g.view) * entering;
    vfloat matter = one - metallic;
    g.through = matter * transmission;
    vmask immersed = b.inside & (g.through > vfloat(0.0F));
    g.inner = select(immersed, ior, one);
    colours.ior = ior;
    // The coat takes its part of all that comes and goes beneath it, by the viewer's angle alone.
    vfloat on_top = coat_fresnel(grazing(g.view, one)) * coat;
    vfloat beneath = one - on_top;
    vfloat scattered = matter * (one - transmission);
    colours.diffuse = colours.albedo * (scattered * beneath);
    vfloat plain = (matter * g.dielectric) * beneath;
    colours.normal = colours.albedo * (metallic * beneath);
    colours.normal = colours.normal + vvec{plain, plain, plain};
    colours.grazing = fma(matter, specular, metallic) * beneath;
    colours.through = colours.albedo * (g.through * beneath);
    // Bounces: as much as each lobe reflects of what comes from about the mirror direction.
    vfloat graze = grazing(g.view, g.inner);
    vfloat rise = colours.grazing - largest(colours.normal);
    vfloat base = fma(graze, rise, largest(colours.normal));
    base = base + largest(colours.through);
    vfloat all = base + on_top;
    vfloat dim = largest(colours.diffuse);
    dim = select(vmask(onward.diffuse), dim, vfloat(0.0F));
    all = max(all + dim, 1.0e-12F);
    vfloat per_share = reciprocal(all);
    per_share = select(vmask(onward.at_all), per_share, vfloat(0.0F));
    g.coat_share = on_top * per_share;
    g.scatters = onward.diffuse;
    g.base_share = base * per_share;
    return g;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
