// Sheen: what fibres that stand off a surface reflect at grazing angles, over all but a clear coat. The
// distribution of normals of Estevez & Kulla (Production Friendly Microfacet Sheen BRDF, 2017) with their
// shadowing, as in glTF's KHR_materials_sheen. What lies below keeps 1 - the sheen's albedo of whichever of
// both directions has more of it. That fitted lobe gives back more than it gets at grazing angles where it is
// narrow: there it is divided by its albedo. Albedos are tabled by the cosine, and where maps say how rough
// fibres are by that, too.
//
// It is broad: like diffuse reflection it is a part of what goes in all directions.
#pragma once

#include "razor/frame/sheen_albedo.h"
#include "razor/kernels/material.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

inline constexpr int lobe_sheen = lobe_count; // behind those of Glossy
static_assert(3 * (lobe_count + 1) == most_lobes);

/// Of a row of albedos, which are straight between its places, `beyond` the one at that word.
inline vfloat albedo_in_row(pointer<float> albedos, const vint& word, const vfloat& beyond, const vmask& m) {
    vfloat low = gather(albedos, word, m);
    vfloat high = gather(albedos, word + vint(1), m);
    return fma(beyond, high - low, low);
}

/// Where a lobe's albedos are: those of one roughness.
struct OneRow {
    vint first; // word
    OneRow permuted(const vint& from) const { return {permute(first, from)}; }
    vfloat albedo(pointer<float> albedos, const vint& step, const vfloat& beyond, const vmask& m) const {
        return albedo_in_row(albedos, first + step, beyond, m);
    }
};
/// Those of a roughness that a map says, between two rows.
struct TwoRows {
    vint first, second;
    vfloat part; // of the second
    TwoRows permuted(const vint& from) const {
        return {permute(first, from), permute(second, from), permute(part, from)};
    }
    vfloat albedo(pointer<float> albedos, const vint& step, const vfloat& beyond, const vmask& m) const {
        vfloat low = albedo_in_row(albedos, first + step, beyond, m);
        vfloat high = albedo_in_row(albedos, second + step, beyond, m);
        return fma(part, high - low, low);
    }
};

/// Of surfaces with sheen over whatever else they have. Rows: OneRow or TwoRows, so that only where roughness
/// has maps hits read twice as many albedos.
template <class Rows> struct Cloth : Glossy {
    static constexpr int lobes = lobe_count + 1;
    vvec sheen;            // colour, below the coat; not permuted
    vfloat strength;       // largest of it, the coat apart
    vfloat steepness;      // 1 / alpha
    vfloat fit[5], middle; // of lambda; twice what is fitted at 1/2
    vfloat view_lambda, view_albedo;
    Rows rows;
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
        p.rows = rows.permuted(from);
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
template <class Rows> inline vfloat sheen_lambda(const Cloth<Rows>& g, const vfloat& cosine) {
    vmask low = cosine < vfloat(0.5F);
    vfloat other = vfloat(1.0F) - cosine;
    vfloat fitted = fitted_lambda(g.fit, select(low, cosine, other));
    vfloat mirrored = g.middle - fitted;
    return exp(select(low, fitted, mirrored));
}

template <class Rows>
inline vfloat sheen_albedo_at(const Cloth<Rows>& g, const vfloat& cosine, const vmask& m) {
    constexpr float steps = sheen_steps - 1;
    vfloat place = sqrt(cosine) * steps;
    vint step = to_int(place);
    step = min(step, vint(sheen_steps - 2));
    vfloat beyond = place - to_float(step);
    return g.rows.albedo(g.albedos, step, beyond, m);
}

/// What light from one direction has to do with it: what is left below, and pi times what it reflects, by its
/// colour of 1.
struct SheenPart {
    vfloat kept, reflected;
};
/// `cosine`: of the light to the normal, from whichever side. `direction`: to it, unit.
template <class Rows>
inline SheenPart sheen_part(const Cloth<Rows>& g, const Surface& s, const vvec& direction,
                            const vfloat& cosine, const vmask& m) {
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

template <class Rows>
template <class Domain>
inline void Cloth<Rows>::reflect(const Surface& s, const LightRays& l, const Domain& over, sint samples,
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

template <class Rows>
inline void Cloth<Rows>::reflect_sky(const Surface& s, const LightRays& l, vfloat (&part)[lobes]) const {
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
template <class Rows>
inline void set_sheen(Cloth<Rows>& g, const vfloat& alpha, const Rows& rows, pointer<float> albedos,
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
    g.rows = rows;
    g.albedos = albedos;
    vfloat view = min(max(g.view, least_sheen_cosine), 1.0F);
    g.view_lambda = sheen_lambda(g, view);
    g.view_albedo = sheen_albedo_at(g, view, m);
}

} // namespace light_kernel

inline namespace shade_kernel {

/// What stands off a hit's surface.
struct Fibres {
    vvec colour; // black: nothing
    vfloat alpha;
    OneRow row;
    TwoRows rows; // with sheen_rows
};

/// Which rows of their tables those roughnesses lie between.
inline TwoRows rows_beside(const Sheens& of, const vint& table, const vfloat& roughness) {
    vfloat root = sqrt(roughness);
    vfloat place = root - of.number(&SheenRecord::first_root);
    place = place * of.number(&SheenRecord::per_root);
    vfloat last = of.number(&SheenRecord::last_row);
    place = min(max(place, 0.0F), last);
    vfloat row = floor(place);
    vfloat next = min(row + vfloat(1.0F), last);
    TwoRows r;
    r.first = to_int(row) * vint(sheen_steps) + table;
    r.second = to_int(next) * vint(sheen_steps) + table;
    r.part = place - row;
    return r;
}

/// As maps make them.
[[gnu::noinline]] inline void weave(const Context& c, const Sheens& of, const Beyond& b, sint sheens,
                                    Fibres& f) {
    f.colour = mapped_sheen(c, of, b.map, b.known);
    if (branch(sheens == sheen_rows)) {
        vfloat roughness = mapped_sheen_roughness(c, of, b.map, b.known);
        f.alpha = select(of.present, roughness * roughness, vfloat(1.0F));
        f.rows = rows_beside(of, f.row.first, roughness);
    }
}

template <bool Mapped>
inline Fibres find_fibres(const Context& c, const Surface& s, const Beyond& b, sint sheens) {
    Sheens of = sheens_of(c, materials_of(c, b.material, s.hit));
    Fibres f;
    f.colour = of.colour(&SheenRecord::colour);
    f.alpha = select(s.hit, of.number(&SheenRecord::alpha), vfloat(1.0F));
    f.row.first = of.whole(&SheenRecord::table);
    if constexpr (Mapped) {
        if (branch(sheens >= sheen_mapped))
            weave(c, of, b, sheens, f);
    }
    return f;
}

/// Shading normals of surfaces with sheen are turned to face the viewer, as those of others that are not
/// matte are.
inline void face_sheen(const Fibres& f, const Beyond& b, Surface& s) {
    vmask has = s.hit & (largest(f.colour) > vfloat(0.0F));
    s.shading = select(has, facing(s.shading, b.toward), s.shading);
}

/// The surface's lobes with sheen on top of them.
template <class Rows>
inline Cloth<Rows> cover(const Context& c, const Surface& s, const Fibres& f, const Rows& rows,
                         const Glossy& under, const Colours& colours, const Onward& onward) {
    Cloth<Rows> g;
    static_cast<Glossy&>(g) = under;
    vfloat one(1.0F);
    g.strength = largest(f.colour);
    set_sheen(g, f.alpha, rows, load(field(c.frame, &FrameHeader::sheen_albedo)), s.hit);
    vfloat on_top = coat_fresnel(grazing(g.view, one)) * g.coat;
    g.sheen = f.colour * (one - on_top);
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
