// Where light goes on from a hit, backwards: one direction of one lobe for each ray, by chance as much as the
// lobe is worth.
#pragma once

#include "razor/kernels/leave.h"
#include "razor/kernels/sheen.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

struct Bounce {
    Rays rays;      // active where light goes on
    vvec carried;   // what of the radiance from there goes to the viewer
    vfloat density; // of that direction among all of its lobe, times the lobe's share
    vmask diffuse;  // in all directions: a sky without a map, or without samples, is not for them
};

/// What is chosen of the base, by a normal: a direction, its lobe's factor and density.
struct BaseSample {
    vvec direction, factor;
    vfloat density;
    vmask passes; // through the surface
};

/// Of what a surface reflects or lets through, the share that what covers it leaves in that direction.
template <class Rows>
inline vfloat left_below(const Cloth<Rows>& g, const Surface& s, const vvec& direction, const vmask& m) {
    vfloat cosine = abs(dot(s.shading, direction));
    return sheen_part(g, s, direction, cosine, m).kept;
}
/// What is scattered that way for light that comes with that cosine.
inline vvec scattered(const Glossy& g, const Surface&, const Colours& colours, const vvec&,
                      const vfloat& cosine, const vfloat& rest, const vmask&) {
    vfloat kept = kept_below(g, cosine);
    return colours.diffuse * (kept / rest);
}
template <class Rows>
inline vvec scattered(const Cloth<Rows>& g, const Surface& s, const Colours& colours, const vvec& direction,
                      const vfloat& cosine, const vfloat& rest, const vmask& m) {
    SheenPart top = sheen_part(g, s, direction, cosine, m);
    vfloat kept = kept_below(g, cosine) * top.kept;
    vvec below = colours.diffuse * (kept / rest);
    return madd(top.reflected / rest, g.sheen, below);
}

/// `choice`: in [0, 1), by which it is reflected or passes.
inline BaseSample sample_base(const Surface& s, const Beyond& b, const Glossy& g, const Colours& colours,
                              const vvec& h, const vfloat& choice) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vfloat cos_view = dot(g.toward, h);
    vfloat graze = grazing(cos_view, g.inner);
    vfloat reflected = reflection_share(g, graze);
    BaseSample out;
    out.passes = choice >= reflected;
    // Reflected about the normal, or refracted (Snell): light comes along -direction.
    vfloat twice = cos_view + cos_view;
    vvec mirrored = h * twice - g.toward;
    vfloat eta = select(b.inside, colours.ior, one / colours.ior);
    vfloat cos_square = cos_view * cos_view;
    vfloat bend = eta * eta;
    vfloat sine_square = (one - cos_square) * bend;
    vfloat cos_through = sqrt(max(one - sine_square, 0.0F));
    vfloat turn = fms(eta, cos_view, cos_through);
    vvec bent = g.toward * eta;
    bent = h * turn - bent;
    out.direction = select(out.passes, bent, mirrored);
    vfloat cosine = abs(dot(s.shading, out.direction));
    cosine = max(cosine, 1.0e-6F);
    // G2 / G1: normals are as they are seen.
    vfloat seen = visibility(g.view, g.base_norm, cosine, slope_norm(cosine, g.alpha));
    vfloat sum = g.view + g.base_norm;
    sum = sum + sum;
    vfloat unshadowed = (seen * cosine) * sum;
    vmask smooth = g.alpha < vfloat(smooth_alpha);
    unshadowed = select(smooth, one, unshadowed);
    vvec rise = vvec{colours.grazing, colours.grazing, colours.grazing} - colours.normal;
    vvec mirror_colour = madd(graze, rise, colours.normal);
    // Radiance is compressed into the narrower cone on the denser side.
    vfloat passed = (one - dielectric_reflection(g, graze)) * bend;
    vvec colour = select(out.passes, colours.through * passed, mirror_colour);
    vfloat share = select(out.passes, one - reflected, reflected);
    share = share * g.base_share;
    out.factor = colour * (unshadowed / max(share, 1.0e-12F));
    vfloat cos_half = dot(s.shading, h);
    vvec across = cross(s.shading, h);
    vfloat distribution = pi_distribution(cos_half, dot(across, across), g.alpha);
    vfloat density = reflected_density(distribution, g.view, g.base_norm) * share;
    vfloat sharp(delta_density);
    out.density = select(smooth, sharp, select(out.passes, sharp, density)); // no light is sampled through it
    vmask bends = sine_square < one;
    out.factor = select(out.passes & !bends, {zero, zero, zero}, out.factor);
    return out;
}

/// Of the coat: a direction, its factor and density.
inline void sample_coat(const Surface& s, const Glossy& g, const vvec& h, BaseSample& out) {
    vfloat one(1.0F);
    vfloat cos_view = dot(g.toward, h);
    vfloat twice = cos_view + cos_view;
    out.direction = h * twice - g.toward;
    vfloat cosine = max(dot(s.shading, out.direction), 1.0e-6F);
    vfloat seen = visibility(g.view, g.coat_norm, cosine, slope_norm(cosine, g.coat_alpha));
    vfloat sum = g.view + g.coat_norm;
    sum = sum + sum;
    vfloat unshadowed = (seen * cosine) * sum;
    vmask smooth = g.coat_alpha < vfloat(smooth_alpha);
    unshadowed = select(smooth, one, unshadowed);
    vfloat reflected = coat_fresnel(grazing(cos_view, one)) * g.coat;
    vfloat share = max(g.coat_share, 1.0e-12F);
    vfloat factor = (reflected * unshadowed) / share;
    out.factor = {factor, factor, factor};
    vfloat cos_half = dot(s.shading, h);
    vvec across = cross(s.shading, h);
    vfloat distribution = pi_distribution(cos_half, dot(across, across), g.coat_alpha);
    vfloat density = reflected_density(distribution, g.view, g.coat_norm) * g.coat_share;
    out.density = select(smooth, vfloat(delta_density), density);
    out.passes = vmask(false);
}

/// A normal of the distribution of that width, as often as the viewer sees it, in world coordinates.
inline vvec sample_facing(const Surface& s, const Glossy& g, const vfloat& alpha, const vpoint& square) {
    Basis basis = basis_about(s.shading);
    vvec view;
    view.x = dot(basis.x, g.toward);
    view.y = dot(basis.y, g.toward);
    view.z = g.view;
    vvec h = sample_normal(view, alpha, square);
    vvec w = madd(h.y, basis.y, basis.x * h.x);
    w = madd(h.z, s.shading, w);
    return select(alpha < vfloat(smooth_alpha), s.shading, w);
}

/// What bounces ask of surfaces: rays of a pixel part by what they parted before, by what the surface's
/// curvature adds to that (twice the turn of the normal, over an edge as long as was asked for), and by how
/// far samples of the lobe lie apart.
inline vfloat growth_of_bounce(const Context& c, const Surface& s, const Beyond& b, const vfloat& density) {
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::lobe_spacing));
    vfloat apart = spacing * reciprocal_sqrt(max(density, 1.0e-6F));
    vfloat bulge = max(b.curvature, 0.0F) * s.target;
    vfloat mirrored = fma(bulge, vfloat(2.0F), s.growth);
    return mirrored + apart;
}

inline constexpr float growth_steps = 8.0F; // from 0 to the cap

/// As leave_surface(), but each ray's targets grow about as fast as it asks for, by a step less at most:
/// lobes of one packet may be as wide as all directions, or mirrors. They leave from a point of the ray that
/// came, `toward` where it came from: above all of the block if that is steep.
inline void leave_apart(const Context& c, const Surface& s, const vvec& toward, const vfloat& growth,
                        Rays& r) {
    Surface leaving = s;
    vmask steep = dot(s.chord_normal, toward) > s.chord_slope;
    leaving.block = select(steep, s.block, vint(-1));
    vfloat step(gradation_cap / growth_steps);
    for (vmask left = r.active; branch(any(left));) {
        Rays some = r;
        vfloat slowest = vfloat(reduce_min(select(left, growth, vfloat(infinite))));
        some.active = left & (growth < slowest + step);
        some.active = some.active | (left & (slowest >= vfloat(gradation_cap)));
        some.active = some.active | (left & !(growth >= slowest)); // no number at all
        leaving.hit = some.active;
        left = left & !some.active;
        leave_surface(c, leaving, growth, some);
        r.field_origin = select(some.active, some.field_origin, r.field_origin);
        r.radius = select(some.active, some.radius, r.radius);
        r.base = select(some.active, some.base, r.base);
        r.growth = select(some.active, some.growth, r.growth);
        r.slope = select(some.active, some.slope, r.slope);
        r.number = select(some.active, some.number, r.number);
        r.left = select(some.active, some.left, r.left);
    }
}

/// Response: Glossy or Cloth.
template <class Response>
[[gnu::noinline]] inline Bounce sample_bounce(const Context& c, const Surface& s, const Beyond& b,
                                              const Response& g, const Colours& colours,
                                              const Onward& onward) {
    phase_scope phase(phase_shade);
    vfloat zero(0.0F);
    vpoint square = sample_square(s.pixel, s.sample, dimension_lobe);
    vpoint which = sample_square(s.pixel, s.sample, dimension_choice);
    vfloat choice = which.u;
    vmask of_coat = choice < g.coat_share;
    choice = choice - g.coat_share;
    vmask of_base = choice < g.base_share;
    of_base = of_base & !of_coat;
    vvec h = sample_facing(s, g, g.alpha, square);
    BaseSample way = sample_base(s, b, g, colours, h, which.v);
    if constexpr (Response::lobes > Glossy::lobes)
        way.factor = way.factor * left_below(g, s, way.direction, s.hit);
    if (branch(any(s.hit & of_coat))) {
        BaseSample on_top;
        sample_coat(s, g, sample_facing(s, g, g.coat_alpha, square), on_top);
        way.direction = select(of_coat, on_top.direction, way.direction);
        way.factor = select(of_coat, on_top.factor, way.factor);
        way.density = select(of_coat, on_top.density, way.density);
        way.passes = way.passes & !of_coat;
    }
    Bounce out;
    out.diffuse = !(of_base | of_coat);
    out.diffuse = out.diffuse & vmask(onward.diffuse); // matte surfaces have no other lobe to choose
    vfloat rest = scattered_share(g);
    out.diffuse = out.diffuse & (rest > vfloat(0.0F));
    if (branch(any(s.hit & out.diffuse))) {
        vfloat cosine;
        vvec direction = sample_cosine(s.shading, square, cosine);
        vvec factor = scattered(g, s, colours, direction, cosine, rest, s.hit);
        way.direction = select(out.diffuse, direction, way.direction);
        way.factor = select(out.diffuse, factor, way.factor);
        way.density = select(out.diffuse, scattered_density(g, cosine), way.density);
        way.passes = way.passes & !out.diffuse;
    }
    vmask chosen = of_base | of_coat;
    chosen = chosen | out.diffuse;
    // Both normals must agree on which side it goes.
    vfloat shaded = dot(s.shading, way.direction);
    vfloat real = dot(s.geometric, way.direction);
    vmask above = shaded > zero;
    above = above & (real > zero);
    vmask below = shaded < zero;
    below = below & (real < zero);
    vmask right = (way.passes & below) | above;
    right = right & !(way.passes & above);
    out.carried = way.factor;
    out.density = way.density;
    vmask bright = largest(way.factor) > zero;
    Rays& r = out.rays;
    r.origin = select(way.passes, b.position, b.before);
    r.direction = way.direction * reciprocal_sqrt(dot(way.direction, way.direction));
    r.t_min = zero;
    r.t_max = vfloat(infinite);
    r.active = s.hit & chosen;
    r.active = r.active & right;
    r.active = r.active & bright;
    leave_apart(c, s, b.toward, growth_of_bounce(c, s, b, out.density), r);
    return out;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
