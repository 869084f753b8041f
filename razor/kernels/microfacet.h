// Reflection by rough surfaces: the distribution of microfacet normals of Trowbridge & Reitz ("GGX"; Walter
// et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007) with heights correlated in
// shadowing and masking (Heitz, Understanding the Masking-Shadowing Function, JCGT 2014). Cosines are to the
// shading normal; alpha is the width of the distribution.
#pragma once

#include "razor/kernels/sampling.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Below this width a surface is a mirror, and its distribution none (pbrt's TrowbridgeReitzDistribution::
/// EffectivelySmooth).
inline constexpr float smooth_alpha = 1.0e-3F;
/// What stands for the density of a mirror's one direction.
inline constexpr float delta_density = 1.0e18F;

/// pi D(h), of the cosine of h and the square of its sine: told apart, so that narrow lobes are exact.
inline vfloat pi_distribution(const vfloat& cosine, const vfloat& sine_square, const vfloat& alpha) {
    vfloat square = alpha * alpha;
    vfloat height = cosine * cosine;
    vfloat t = fma(height, square, sine_square);
    return square / (t * t);
}

/// sqrt(cos^2 + alpha^2 sin^2): G1 = 2 cos / (cos + this).
inline vfloat slope_norm(const vfloat& cosine, const vfloat& alpha) {
    vfloat square = alpha * alpha;
    vfloat height = cosine * cosine;
    vfloat rest = vfloat(1.0F) - height;
    return sqrt(fma(square, max(rest, 0.0F), height));
}

/// G2 / (4 cos cos), of both cosines and their slope_norm().
inline vfloat visibility(const vfloat& view, const vfloat& view_norm, const vfloat& light,
                         const vfloat& light_norm) {
    vfloat one = light * view_norm;
    vfloat sum = fma(view, light_norm, one);
    return vfloat(0.5F) / max(sum, 1.0e-20F);
}

/// Density, by solid angle, of directions that view reflects into at normals distributed as they are seen:
/// G1 D / (4 cos).
inline vfloat reflected_density(const vfloat& pi_distribution, const vfloat& view, const vfloat& view_norm) {
    constexpr float half_over_pi = 0.159154943091895336F;
    vfloat sum = view + view_norm;
    return pi_distribution * half_over_pi / sum;
}

/// A normal as often as it is seen from `view`, both with the shading normal as z axis (Dupuy & Benyoub,
/// Sampling Visible GGX Normals with Spherical Caps, HPG 2023).
inline vvec sample_normal(const vvec& view, const vfloat& alpha, const vpoint& square) {
    vvec stretched{view.x * alpha, view.y * alpha, view.z};
    stretched = stretched * reciprocal_sqrt(dot(stretched, stretched));
    vfloat rest = vfloat(1.0F) - square.v;
    vfloat above = vfloat(1.0F) + stretched.z;
    vfloat z = fms(rest, above, stretched.z);
    vfloat sine_square = vfloat(1.0F) - z * z;
    vfloat sine = sqrt(max(sine_square, 0.0F));
    vfloat angle = square.u * 6.28318530717958647692F;
    vvec h;
    h.x = fma(sine, cos(angle), stretched.x);
    h.y = fma(sine, sin(angle), stretched.y);
    h.x = h.x * alpha;
    h.y = h.y * alpha;
    h.z = max(z + stretched.z, 1.0e-9F);
    return h * reciprocal_sqrt(dot(h, h));
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
