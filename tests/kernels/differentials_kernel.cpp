#include "tests/kernels/differentials_kernel.h"

#include "razor/kernels/differentials.h"
#include "razor/kernels/sampling.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

namespace {

struct Three {
    float* values;
    int count;
    vvec at(int i) const {
        pointer<float> p(values + i);
        vvec v;
        v.x = load_vector(p);
        v.y = load_vector(p + count);
        v.z = load_vector(p + 2 * count);
        return v;
    }
    void set(int i, const vvec& v) const {
        pointer<float> p(values + i);
        store_vector(p, v.x);
        store_vector(p + count, v.y);
        store_vector(p + 2 * count, v.z);
    }
};

vfloat at(float* values, int i) {
    return load_vector(pointer<float>(values + i));
}

} // namespace

void differentials(const DifferentialArrays& a);
void differentials(const DifferentialArrays& a) {
    const auto three = [&](float* values) { return Three{values, a.count}; };
    for (int i = 0; i < a.count; i += isa::width) {
        vvec d = three(a.d).at(i);
        vvec unit = d * reciprocal_sqrt(dot(d, d));
        vfloat t = at(a.t, i);
        RayDifferential r = pinhole_differential(d, three(a.film_x).at(i), three(a.film_y).at(i));
        RayDifferential moved = transfer(r, unit, t, three(a.normal).at(i));
        RayDifferential parallel = orthographic_differential(three(a.film_x).at(i), three(a.film_y).at(i));
        RayDifferential lens = lens_differential(d, three(a.lens_x).at(i), three(a.lens_y).at(i));
        three(a.direction_x).set(i, r.direction_x);
        three(a.direction_y).set(i, r.direction_y);
        three(a.origin_x).set(i, moved.origin_x);
        three(a.origin_y).set(i, moved.origin_y);
        store_vector(pointer<float>(a.across + i), footprint(r, unit, t));
        store_vector(pointer<float>(a.moved_across + i), footprint(moved, unit, vfloat(0.0F)));
        store_vector(pointer<float>(a.lens_across + i), footprint(lens, unit, t));
        store_vector(pointer<float>(a.parallel_across + i), footprint(parallel, unit, t));
        vfloat u = at(a.square_u, i);
        vpoint disk = concentric_disk({u, at(a.square_v, i)});
        store_vector(pointer<float>(a.disk_x + i), disk.u);
        store_vector(pointer<float>(a.disk_y + i), disk.v);
        vfloat spacing = at(a.spacing, i);
        vfloat cosine = at(a.cosine, i);
        vfloat to_area = growth_to_area(at(a.base, i), spacing, cosine, at(a.inverse_distance, i));
        store_vector(pointer<float>(a.growth_to_area + i), to_area);
        store_vector(pointer<float>(a.growth_to_sky + i), growth_to_sky(spacing, cosine));
    }
}

} // namespace razor::test::ISA_TARGET
