// How far apart neighbouring rays are. Of camera rays: ray differentials (Igehy, Tracing Ray Differentials,
// SIGGRAPH 1999), for a step of one pixel. Of rays to one of n samples of a lens, a light or the sky: path
// differentials (Suykens & Willems, Path Differentials and Applications, EGWR 2001), for the step to a
// neighbouring sample.
//
// Packets carry of all this one length a ray, its footprint: the side of the square that has the area of the
// parallelogram between neighbouring rays, measured across the ray. Area, because neighbours of samples of
// density p take 1 / (n p) of it however the samples are parametrised, while their smaller distance depends
// on it; across the ray and not on what it hits, because all rays of a field see one surface, so that what
// they ask for is a function of place and not of orientation: surfaces seen at a grazing angle are as fine as
// if they faced the ray. Target edge lengths are footprints times edge_pixels.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {

/// Derivatives of a ray's origin and unit direction for one step along x and along y.
struct RayDifferential {
    vvec origin_x, origin_y;
    vvec direction_x, direction_y;
};

/// The derivative of d / |d| where that of d is `step`: ((d.d) step - (d.step) d) / (d.d)^(3/2) (Igehy, eq.
/// 8).
inline vvec unit_derivative(const vvec& d, const vvec& step) {
    vfloat inverse = reciprocal_sqrt(dot(d, d));
    vvec unit = d * inverse;
    vvec rate = step * inverse;
    vfloat along = dot(unit, rate);
    return madd(-along, unit, rate);
}

/// Of a ray of a pinhole through the film point `d` from it; film_x, film_y: a pixel's steps there.
inline RayDifferential pinhole_differential(const vvec& d, const vvec& film_x, const vvec& film_y) {
    vfloat zero(0.0F);
    vvec still{zero, zero, zero};
    return {still, still, unit_derivative(d, film_x), unit_derivative(d, film_y)};
}

/// Of a ray along the line of sight of an orthographic camera: neighbours begin a pixel's steps away and stay
/// parallel, so that footprints are the same wherever they are measured.
inline RayDifferential orthographic_differential(const vvec& film_x, const vvec& film_y) {
    vfloat zero(0.0F);
    vvec still{zero, zero, zero};
    return {film_x, film_y, still, still};
}

/// Of a ray from a point of a thin lens through `focus` (from that point to where the rays of a pixel meet),
/// for neighbouring points of the lens, lens_x and lens_y away.
inline RayDifferential lens_differential(const vvec& focus, const vvec& lens_x, const vvec& lens_y) {
    vfloat minus(-1.0F);
    RayDifferential r;
    r.origin_x = lens_x;
    r.origin_y = lens_y;
    r.direction_x = unit_derivative(focus, lens_x * minus);
    r.direction_y = unit_derivative(focus, lens_y * minus);
    return r;
}

/// Moved by t along the unit direction to a surface of normal n (of any length): origins stay on the surface
/// (Igehy, eqs. 10 to 12).
inline RayDifferential transfer(const RayDifferential& r, const vvec& direction, const vfloat& t,
                                const vvec& n) {
    RayDifferential moved = r;
    vfloat inverse = reciprocal(dot(direction, n));
    vvec x = madd(t, r.direction_x, r.origin_x);
    vvec y = madd(t, r.direction_y, r.origin_y);
    vfloat t_x = -dot(x, n) * inverse;
    vfloat t_y = -dot(y, n) * inverse;
    moved.origin_x = madd(t_x, direction, x);
    moved.origin_y = madd(t_y, direction, y);
    return moved;
}

/// Across the unit direction, at distance t: see above. Transferred differentials have the same.
inline vfloat footprint(const RayDifferential& r, const vvec& direction, const vfloat& t) {
    vvec x = madd(t, r.direction_x, r.origin_x);
    vvec y = madd(t, r.direction_y, r.origin_y);
    return sqrt(abs(dot(cross(x, y), direction)));
}

/// Growth with distance of the footprint of a ray to one of n points of an area of uniform density, as far
/// away as 1 / inverse_distance. It begins with the footprint `base` of what is lit, whose neighbours look at
/// the same point and so approach one another, and ends with its share of the area, projected: spacing =
/// sqrt(area / n), cosine of the light's normal. It shrinks where the samples lie closer than base.
inline vfloat growth_to_area(const vfloat& base, const vfloat& spacing, const vfloat& cosine,
                             const vfloat& inverse_distance) {
    vfloat share = sqrt(max(cosine, 0.0F));
    return fms(share, spacing, base) * inverse_distance;
}

/// The same of a ray in one of n directions of density cosine / pi, to the sky, where neighbours of what is
/// lit stay parallel: spacing = sqrt(pi / n). Without end at the horizon, where directions lie sparsest.
inline vfloat growth_to_sky(const vfloat& spacing, const vfloat& cosine) {
    return spacing * reciprocal_sqrt(max(cosine, 1.0e-12F));
}

} // namespace razor::ISA_TARGET
