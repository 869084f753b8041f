// What rays ask for in the paper's scheme ("Razor", Djeu et al., TOG 2011), to compare with: a function of
// the distance along the ray alone. Of the two meshes between which it lies, level k and level k + 1 of
// everything, a vertex of the finer one is blended towards the coarser one by where it projects on the ray
// (equations 1 to 6). As double-precision reference and kernels do for their own scheme, the blend fills the
// last quarter of an octave, and growth of either sign is capped; where the paper prints it the wrong way
// round for a growing footprint, it is fine where the footprint is small.
#pragma once

#include "razor/kernels/blend.h"
#include "razor/kernels/fields.h"

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

/// At distance t a ray asks for |blur + rate t| + growth max(t - from, 0), times level_rounding: what its
/// field says at its origin, going on from there.
struct Scale {
    vfloat blur, rate, growth, from;
    vvec direction; // components in the order of whoever uses it
};

inline Scale scale_of(const Context& c, const Rays& r) {
    Fields f = load_fields(c);
    vvec way = r.origin - f.origin;
    Scale s;
    s.blur = dot(f.slope, way) + f.base;
    s.rate = dot(f.slope, r.direction);
    s.growth = f.growth;
    s.from = f.radius - sqrt(dot(way, way));
    s.direction = r.direction;
    return s;
}

inline vfloat target_along(const Scale& s, const vfloat& t) {
    vfloat blurred = abs(fma(s.rate, t, s.blur));
    vfloat way = max(t - s.from, vfloat(0.0F));
    vfloat target = fma(s.growth, way, blurred);
    return max(target, vfloat(least_target));
}

/// Bounds of what is asked for between two distances; `slack`: what these may be off.
struct Asked {
    vfloat least, most;
};
inline Asked asked_between(const Scale& s, const vfloat& begin, const vfloat& end, sfloat slack) {
    vfloat a = fma(s.rate, begin, s.blur);
    vfloat b = fma(s.rate, end, s.blur);
    vfloat low = min(a, b);
    vfloat high = max(a, b);
    vfloat zero(0.0F);
    vfloat near = max(begin - s.from, zero) * s.growth;
    vfloat far = max(end - s.from, zero) * s.growth;
    Asked asked;
    asked.least = max(max(low, -high), zero);
    asked.least = asked.least + min(near, far);
    vfloat most = max(high, -low);
    asked.most = most + max(near, far);
    vfloat size = max(most, abs(s.blur));
    size = max(size, abs(far));
    vfloat steepest = abs(s.rate);
    steepest = steepest + abs(s.growth);
    vfloat margin = fma(size, vfloat(1.0e-5F), steepest * slack);
    asked.least = max(asked.least - margin, vfloat(least_target));
    asked.most = max(asked.most + margin, vfloat(least_target));
    return asked;
}

/// The pair of levels, k and k + 1, that a target edge length lies between: the number of its octave.
inline vint pair_of(const vfloat& target) {
    return (as_int(target) >> 23) - vint(127);
}

/// Level k of everything is what a field sees that asks for 2^k everywhere: that field's number, which no
/// ray's has.
inline sint number_of_level(sint k) {
    return k - 1024;
}
inline sint level_of_number(sint number) {
    return number + 1024;
}

/// The slot that holds block `line` as it is at level k, with normals if these were asked for. What holds
/// level k + 1 lies elsewhere.
inline pointer<float> level_slot(const Context& c, sint k, sint line) {
    sint number = number_of_level(k);
    Kept kept = find_blended(c, number, line, no_leaf);
    if (branch(!kept.there)) {
        Field f;
        f.origin = {sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
        f.slope = f.origin;
        f.radius = 0.0F;
        f.growth = 0.0F;
        f.base = power_of_two(k);
        blend_block(c, f, number, line, no_leaf, kept.slot);
    }
    return kept.slot;
}

/// Weight of a vertex of level k that projects to distance t (equations 2 to 5).
inline vfloat pair_weight(const Scale& s, const vfloat& t, sint k) {
    vfloat target = target_along(s, t);
    return weight_of(target, vint(k));
}

/// Equation 6.
inline vvec blend_pair(const vfloat& weight, const vvec& fine, const vvec& coarse) {
    vfloat rest = vfloat(1.0F) - weight;
    return madd(weight, fine, coarse * rest);
}

} // namespace intersect_kernel
} // namespace razor::ISA_TARGET
