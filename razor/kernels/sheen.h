// Sheen: what fibres that stand off a surface reflect at grazing angles, over all but a clear coat. The
// distribution of normals of Estevez & Kulla (Production Friendly Microfacet Sheen BRDF, 2017) with their
// shadowing, as in glTF's KHR_materials_sheen. What lies below keeps 1 - the sheen's albedo of whichever of
// both directions has more of it. That fitted lobe gives back more than it gets at grazing angles where it is
// narrow: there it is divided by its albedo.
//
// It is broad: like diffuse reflection it is a part of what goes in all directions.
#pragma once

#include "razor/frame/sheen_albedo.h"
#include "razor/kernels/material.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

inline constexpr int lobe_sheen = lobe_count; // behind those of Glossy
static_assert(3 * (lobe_count + 1) == most_lobes);

/// Of surfaces with sheen over whatever else they have.
struct Cloth : Glossy {
    static constexpr int lobes = lobe_count + 1;
    vvec sheen;            // colour, below the coat; not permuted
    vfloat strength;       // largest of it, the coat apart
    vfloat steepness;      // 1 / alpha
    vfloat fit[5], middle; // of lambda; twice what is fitted at 1/2
    vfloat view_lambda, view_albedo;
    vint table; // first word of its albedos
    pointer<float> albedos;

    Cloth permuted(const vint& from) const {
        Cloth p;
        static_cast<Glossy&>(p) = Glossy::permuted(from);
        p.strength = permute(strength, from);
        p.steepness = permute(steepness, from);
        for (int k = 0; k < 5; ++k)
            p.fit[k] = permute(fit[k], from);
        p.middle = permute(middle, from);
        p.view_lambda = permute(view_lambda, from);
        p.view_albedo = permute(view_albedo, from);
        p.table = permute(table, from);
        p.albedos = albedos;
        return p;
    }
    template <class Domain>
    inline void reflect(const Surface& s, const LightRays& l, const Domain& over, sint samples,
                        vfloat (&part)[lobes]) const;
    inline void reflect_sky(const Surface& s, const LightRays& l, vfloat (&part)[lobes]) const;
};

/// Estevez & Kulla 2017, equation 3.
inline vfloat fitted_lambda(const vfloat (&fit)[5], const vfloat& x) {
    vfloat power = pow(x, fit[2]);
    vfloat below = fma(fit[1], power, vfloat(1.0F));
    vfloat line = fma(fit[3], x, fit[4]);
    return fit[0] / below + line;
}
inline vfloat sheen_lambda(const Cloth& g, const vfloat& cosine) {
    vmask low = cosine < vfloat(0.5F);
    vfloat other = vfloat(1.0F) - cosine;
    vfloat fitted = fitted_lambda(g.fit, select(low, cosine, other));
    vfloat mirrored = g.middle - fitted;
    return exp(select(low, fitted, mirrored));
}

inline vfloat sheen_albedo_at(const Cloth& g, const vfloat& cosine, const vmask& m) {
    constexpr float steps = sheen_steps - 1;
    vfloat place = sqrt(cosine) * steps;
    vint step = to_int(place);
    step = min(step, vint(sheen_steps - 2));
    vfloat beyond = place - to_float(step);
    vint word = g.table + step;
    vfloat low = gather(g.albedos, word, m);
    vfloat high = gather(g.albedos, word + vint(1), m);
    return fma(beyond, high - low, low);
}

/// What light from one direction has to do with it: what is left below, and pi times what it reflects, by its
/// colour of 1.
struct SheenPart {
    vfloat kept, reflected;
};
/// `cosine`: of the light to the normal, from whichever side. `direction`: to it, unit.
inline SheenPart sheen_part(const Cloth& g, const Surface& s, const vvec& direction, const vfloat& cosine,
                            const vmask& m) {
    vfloat one(1.0F);
    vfloat light = min(max(cosine, least_sheen_cosine), 1.0F);
    vfloat view = max(g.view, least_sheen_cosine);
    vfloat most = max(sheen_albedo_at(g, light, m), g.view_albedo);
    SheenPart part;
    part.kept = fnma(g.strength, min(most, 1.0F), one);
    vvec h = normalise(g.toward + direction, g.toward);
    vvec across = cross(s.shading, h);
    vfloat sine_square = min(max(dot(across, across), 1.0e-30F), 1.0F);
    vfloat exponent = g.steepness * 0.5F;
    vfloat spread = exp(exponent * log(sine_square));
    vfloat height = fma(g.steepness, vfloat(0.5F), one); // pi D = (2 + 1 / alpha) / 2 * sin^(1 / alpha)
    vfloat lambdas = g.view_lambda + sheen_lambda(g, light);
    vfloat shadowed = one + lambdas;
    vfloat cosines = view * light;
    vfloat below = (shadowed * cosines) * 4.0F;
    vfloat bounded = below * max(most, 1.0F);
    part.reflected = (spread * height) / bounded;
    return part;
}

template <class Domain>
inline void Cloth::reflect(const Surface& s, const LightRays& l, const Domain& over, sint samples,
                           vfloat (&part)[lobes]) const {
    vfloat own[lobe_count];
    Glossy::reflect(s, l, over, samples, own);
    vfloat cosine = dot(s.shading, l.rays.direction);
    SheenPart top = sheen_part(*this, s, l.rays.direction, cosine, l.rays.active);
    for (int k = 0; k < lobe_count; ++k)
        part[k] = k == lobe_coat ? own[k] : own[k] * top.kept;
    part[lobe_sheen] = l.weight * top.reflected;
    if (branch(scatters)) {
        cosine = max(cosine, 1.0e-9F);
        vfloat density = scattered_density(*this, cosine);
        vfloat of_light = density_of_light(l, over, samples, cosine);
        part[lobe_sheen] = part[lobe_sheen] * power_share(of_light, density);
    }
}

inline void Cloth::reflect_sky(const Surface& s, const LightRays& l, vfloat (&part)[lobes]) const {
    vfloat own[lobe_count];
    Glossy::reflect_sky(s, l, own);
    vfloat cosine = dot(s.shading, l.rays.direction);
    SheenPart top = sheen_part(*this, s, l.rays.direction, cosine, l.rays.active);
    for (int k = 0; k < lobe_count; ++k)
        part[k] = own[k] * top.kept;
    part[lobe_sheen] = l.weight * top.reflected;
}

/// All that does not depend on where light comes from, the viewer's direction, colour and strength being
/// there.
inline void set_sheen(Cloth& g, const vfloat& alpha, const vint& table, pointer<float> albedos,
                      const vmask& m) {
    constexpr float at_0[5] = {25.3245F, 3.32435F, 0.16801F, -1.27393F, -4.85967F};
    constexpr float at_1[5] = {21.5473F, 3.82987F, 0.19823F, -1.97760F, -4.32054F};
    vfloat one(1.0F);
    g.steepness = reciprocal(alpha);
    vfloat rest = one - alpha;
    vfloat part = rest * rest;
    for (int k = 0; k < 5; ++k)
        g.fit[k] = fma(part, vfloat(at_0[k] - at_1[k]), vfloat(at_1[k]));
    vfloat fitted = fitted_lambda(g.fit, vfloat(0.5F));
    g.middle = fitted + fitted;
    g.table = table;
    g.albedos = albedos;
    vfloat view = min(max(g.view, least_sheen_cosine), 1.0F);
    g.view_lambda = sheen_lambda(g, view);
    g.view_albedo = sheen_albedo_at(g, view, m);
}

} // namespace light_kernel

inline namespace shade_kernel {

/// Shading normals of surfaces with sheen are turned to face the viewer, as those of others that are not
/// matte are.
inline void face_sheen(const Context& c, const Beyond& b, Surface& s) {
    Materials of = materials_of(c, b.material, s.hit);
    vmask has = s.hit & (largest(of.colour(&MaterialRecord::sheen)) > vfloat(0.0F));
    s.shading = select(has, facing(s.shading, b.toward), s.shading);
}

/// The surface's lobes with sheen on top of them.
inline Cloth cover(const Context& c, const Surface& s, const Beyond& b, const Glossy& under,
                   const Colours& colours, const Onward& onward) {
    Materials of = materials_of(c, b.material, s.hit);
    Cloth g;
    static_cast<Glossy&>(g) = under;
    vfloat one(1.0F);
    vvec colour = of.colour(&MaterialRecord::sheen);
    vfloat alpha = of.number(&MaterialRecord::sheen_alpha);
    alpha = select(s.hit, alpha, one);
    g.strength = largest(colour);
    vint table = gather(field(of.first, &MaterialRecord::sheen_table), of.record, s.hit);
    set_sheen(g, alpha, table, load(field(c.frame, &FrameHeader::sheen_albedo)), s.hit);
    vfloat on_top = coat_fresnel(grazing(g.view, one)) * g.coat;
    g.sheen = colour * (one - on_top);
    // Of bounces, what goes in all directions gets its share as well.
    vfloat albedo = min(g.view_albedo, 1.0F);
    vfloat more = largest(g.sheen) * albedo;
    more = select(vmask(onward.diffuse), more, vfloat(0.0F));
    vfloat others = largest(colours.diffuse);
    others = others + largest(colours.normal);
    others = others + largest(colours.through);
    others = max(others + on_top, 1.0e-6F);
    vfloat share = others / (others + more);
    g.base_share = g.base_share * share;
    g.coat_share = g.coat_share * share;
    return g;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
