// What surfaces reflect of light that arrives from one direction, apart by lobes so that a light's colour is
// multiplied in once. Of matte surfaces there is one lobe; others follow glTF 2.0 (appendix B): a metal, or a
// dielectric over what it lets through to diffuse reflection or transmission; over both a clear coat.
// Fresnel's equations are Schlick's approximation of them, of the cosine on the thinner side (Schlick, An
// Inexpensive BRDF Model for Physically-Based Rendering, 1994).
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/frame/scratch.h"
#include "razor/kernels/light_samples.h"
#include "razor/kernels/microfacet.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Everything matte: the one lobe has no state.
struct Matte {
    static constexpr int lobes = 1;
    Matte permuted(const vint&) const { return {}; }
    /// Of light that `samples` shadow rays a hit go to, spread over that domain: see LightRecord.
    template <class Domain>
    void reflect(const Surface&, const LightRays& l, const Domain&, sint, vfloat (&part)[lobes]) const {
        part[0] = l.weight;
    }
    void reflect_sky(const Surface&, const LightRays& l, vfloat (&part)[lobes]) const { part[0] = l.weight; }
};

/// What lobes are multiplied with: diffuse reflection; the base at normal incidence; at grazing incidence;
/// the coat.
enum Lobe : int { lobe_diffuse = 0, lobe_normal = 1, lobe_grazing = 2, lobe_coat = 3, lobe_count = 4 };

/// Of a hit: all that does not depend on where light comes from.
struct Glossy {
    static constexpr int lobes = lobe_count;
    vvec toward;             // unit, to the viewer
    vfloat view;             // its cosine, positive
    vfloat alpha, base_norm; // of the base; slope_norm() of view
    vfloat coat_alpha, coat_norm;
    vfloat inner; // index of refraction where the viewer is inside of what is clear, else 1
    vfloat below; // what a dielectric leaves for diffuse reflection, by the viewer's angle: see kept_below()
    vfloat dielectric, specular;   // at normal incidence, at grazing: what is lost to what lies below
    vfloat coat;                   // weight
    vfloat base_share, coat_share; // of bounces, that these lobes take; the rest goes in all directions
    vfloat through;                // weight of transmission against reflection, before Fresnel
    sbool scatters = false;        // whether bounces take that rest

    Glossy permuted(const vint& from) const {
        Glossy p;
        p.toward = permute(toward, from);
        p.view = permute(view, from);
        p.alpha = permute(alpha, from);
        p.base_norm = permute(base_norm, from);
        p.coat_alpha = permute(coat_alpha, from);
        p.coat_norm = permute(coat_norm, from);
        p.inner = permute(inner, from);
        p.below = permute(below, from);
        p.dielectric = permute(dielectric, from);
        p.specular = permute(specular, from);
        p.coat = permute(coat, from);
        p.base_share = permute(base_share, from);
        p.coat_share = permute(coat_share, from);
        p.through = permute(through, from);
        p.scatters = scatters;
        return p;
    }
    template <class Domain>
    inline void reflect(const Surface& s, const LightRays& l, const Domain& over, sint samples,
                        vfloat (&part)[lobes]) const;
    inline void reflect_sky(const Surface& s, const LightRays& l, vfloat (&part)[lobes]) const;
};

/// (1 - c)^5, c being the cosine on the thinner side of the interface; 1 where all is reflected. `inner`: as
/// of Glossy.
inline vfloat grazing(const vfloat& cosine, const vfloat& inner) {
    vfloat square = cosine * cosine;
    vfloat sine_square = vfloat(1.0F) - square;
    vfloat bend = inner * inner;
    vfloat thin_square = fnma(bend, sine_square, vfloat(1.0F));
    vfloat thin = sqrt(max(thin_square, 0.0F));
    vfloat c = vfloat(1.0F) - thin;
    c = max(c, 0.0F);
    vfloat second = c * c;
    return c * (second * second);
}

/// What a dielectric reflects: nothing of it reaches what lies below.
inline vfloat dielectric_reflection(const Glossy& g, const vfloat& graze) {
    vfloat rise = g.specular - g.dielectric;
    return fma(graze, rise, g.dielectric);
}

/// 1 - (1 - c / 2)^5
inline vfloat below_at(const vfloat& cosine) {
    vfloat c = fnma(cosine, vfloat(0.5F), vfloat(1.0F));
    vfloat second = c * c;
    vfloat fourth = second * second;
    return fnma(fourth, c, vfloat(1.0F));
}
/// What reaches the matter below a dielectric from one direction and comes out towards the viewer, so that
/// with what is reflected it is never more than came, and the same both ways (Ashikhmin & Shirley, An
/// Anisotropic Phong BRDF Model, 2000, eq. 5; 1 - Fresnel's factor half way, as in glTF 2.0, gives up to 1.4
/// times what came at grazing angles).
inline vfloat kept_below(const Glossy& g, const vfloat& cos_light) {
    vfloat kept = fms(g.below, below_at(cos_light), vfloat(1.0F));
    return fma(g.specular, kept, vfloat(1.0F));
}

inline constexpr float coat_reflection = 0.04F; // at normal incidence: of index 1.5
inline vfloat coat_fresnel(const vfloat& graze) {
    return fma(graze, vfloat(1.0F - coat_reflection), vfloat(coat_reflection));
}

/// How much of what a lobe reflects of a light is sampled by the light, the rest being left to bounces that
/// meet it by chance: the power heuristic (Veach, Robust Monte Carlo Methods for Light Transport Simulation,
/// 1997, section 9.2.4). `density`: of bounces; `light_density`: of all samples of the light together.
inline vfloat power_share(const vfloat& light_density, const vfloat& density) {
    vfloat ratio = density / max(light_density, 1.0e-30F);
    return reciprocal(fma(ratio, ratio, vfloat(1.0F)));
}

/// pi D V of a lobe, times its share of the light; nothing of a mirror.
inline vfloat lobe_reflection(const Glossy& g, const vfloat& alpha, const vfloat& norm, const vfloat& share,
                              const vfloat& cos_half, const vfloat& sine_square, const vfloat& cos_light,
                              const vfloat& light_density) {
    vfloat distribution = pi_distribution(cos_half, sine_square, alpha);
    vfloat seen = visibility(g.view, norm, cos_light, slope_norm(cos_light, alpha));
    vfloat density = reflected_density(distribution, g.view, norm) * share;
    vfloat kept = power_share(light_density, density);
    vfloat value = (distribution * seen) * kept;
    return select(alpha < vfloat(smooth_alpha), vfloat(0.0F), value);
}

/// The normal half way between the viewer and the light.
inline vvec half_way(const Glossy& g, const LightRays& l) {
    vvec sum = g.toward + l.rays.direction;
    return normalise(sum, g.toward);
}

/// The share of bounces that go in all directions; none where that is too little to be chosen.
inline vfloat scattered_share(const Glossy& g) {
    vfloat rest = vfloat(1.0F) - g.coat_share;
    rest = rest - g.base_share;
    return select(rest > vfloat(1.0e-6F), rest, vfloat(0.0F));
}
/// The density of these, by that cosine of their direction with the normal.
inline vfloat scattered_density(const Glossy& g, const vfloat& cosine) {
    return cosine * (scattered_share(g) * 0.318309886183790672F);
}

/// Bounces in the base's reflection lobe, of all that go by that normal.
inline vfloat reflection_share(const Glossy& g, const vfloat& graze) {
    vfloat reflected = dielectric_reflection(g, graze);
    vfloat passed = (vfloat(1.0F) - reflected) * g.through;
    vfloat all = max(reflected + passed, 1.0e-12F);
    vmask opaque = g.through <= vfloat(0.0F);
    return select(opaque, vfloat(1.0F), reflected / all);
}

/// By solid angle, of all samples of the light together; enormous where no bounce can meet it.
template <class Domain>
inline vfloat density_of_light(const LightRays& l, const Domain& over, sint samples,
                               const vfloat& cos_light) {
    vfloat domain = over.load();
    vfloat spread = max(domain * l.weight, 1.0e-30F);
    vfloat density = (cos_light * vfloat(to_float(samples))) / spread;
    return select(domain > vfloat(0.0F), density, vfloat(delta_density * 1.0e12F));
}

template <class Domain>
inline void Glossy::reflect(const Surface& s, const LightRays& l, const Domain& over, sint samples,
                            vfloat (&part)[lobes]) const {
    vvec h = half_way(*this, l);
    vfloat cos_half = dot(s.shading, h);
    vvec across = cross(s.shading, h);
    vfloat sine_square = dot(across, across);
    vfloat cos_light = max(dot(s.shading, l.rays.direction), 1.0e-9F);
    vfloat graze = grazing(dot(toward, h), inner);
    vfloat light_density = density_of_light(l, over, samples, cos_light);
    part[lobe_diffuse] = l.weight * kept_below(*this, cos_light);
    if (branch(scatters)) {
        vfloat density = scattered_density(*this, cos_light);
        part[lobe_diffuse] = part[lobe_diffuse] * power_share(light_density, density);
    }
    vfloat share = base_share * reflection_share(*this, graze);
    vfloat base =
        lobe_reflection(*this, alpha, base_norm, share, cos_half, sine_square, cos_light, light_density);
    base = base * l.weight;
    part[lobe_grazing] = base * graze;
    part[lobe_normal] = base - part[lobe_grazing];
    vfloat bright = lobe_reflection(*this, coat_alpha, coat_norm, coat_share, cos_half, sine_square,
                                    cos_light, light_density);
    vfloat on_top = coat_fresnel(grazing(dot(toward, h), vfloat(1.0F))) * coat;
    part[lobe_coat] = (bright * l.weight) * on_top;
}

/// Only what is reflected in all directions: bounces see the sky.
inline void Glossy::reflect_sky(const Surface& s, const LightRays& l, vfloat (&part)[lobes]) const {
    vfloat kept = kept_below(*this, dot(s.shading, l.rays.direction));
    part[lobe_diffuse] = l.weight * kept;
    part[lobe_normal] = vfloat(0.0F);
    part[lobe_grazing] = vfloat(0.0F);
    part[lobe_coat] = vfloat(0.0F);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
