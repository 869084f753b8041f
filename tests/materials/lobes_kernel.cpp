#include "tests/materials/lobes_kernel.h"

#include "razor/kernels/microfacet.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

namespace {

vvec load_three(float* values, int count, int i) {
    pointer<float> p(values + i);
    vvec v;
    v.x = load_vector(p);
    v.y = load_vector(p + count);
    v.z = load_vector(p + 2 * count);
    return v;
}

/// pi D V for light from `light` seen from `view`.
vfloat reflectance(const vvec& view, const vvec& light, const vfloat& alpha) {
    vvec h = normalise(view + light, view);
    vfloat flat = h.x * h.x;
    vfloat sine_square = fma(h.y, h.y, flat);
    vfloat distribution = pi_distribution(h.z, sine_square, alpha);
    vfloat view_norm = slope_norm(view.z, alpha);
    return distribution * visibility(view.z, view_norm, light.z, slope_norm(light.z, alpha));
}

} // namespace

void lobes(const LobeArrays& a);
void lobes(const LobeArrays& a) {
    vfloat alpha(a.alpha);
    vvec view{vfloat(a.view[0]), vfloat(a.view[1]), vfloat(a.view[2])};
    for (int i = 0; i < a.count; i += isa::width) {
        vfloat u = load_vector(pointer<float>(a.square_u + i));
        vfloat v = load_vector(pointer<float>(a.square_v + i));
        vvec h = sample_normal(view, alpha, {u, v});
        vfloat along = dot(view, h);
        vvec reflected = h * (along + along) - view;
        pointer<float> out(a.reflected + i);
        store_vector(out, reflected.x);
        store_vector(out + a.count, reflected.y);
        store_vector(out + 2 * a.count, reflected.z);
        vvec light = load_three(a.light, a.count, i);
        vvec half = normalise(view + light, view);
        vfloat flat = half.x * half.x;
        vfloat sine_square = fma(half.y, half.y, flat);
        vfloat distribution = pi_distribution(half.z, sine_square, alpha);
        vfloat density = reflected_density(distribution, view.z, slope_norm(view.z, alpha));
        store_vector(pointer<float>(a.density + i), density);
        store_vector(pointer<float>(a.reflectance + i), reflectance(view, light, alpha));
        store_vector(pointer<float>(a.reverse_reflectance + i), reflectance(light, view, alpha));
    }
}

} // namespace razor::test::ISA_TARGET
