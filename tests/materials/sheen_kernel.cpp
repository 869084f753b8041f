#include "tests/materials/sheen_kernel.h"

#include "razor/kernels/sheen.h"

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

} // namespace

void sheen(const SheenArrays& a);
void sheen(const SheenArrays& a) {
    vfloat zero(0.0F);
    Surface s;
    s.shading = {zero, zero, vfloat(1.0F)};
    for (int i = 0; i < a.count; i += isa::width) {
        Cloth g;
        g.toward = load_three(a.view, a.count, i);
        g.view = g.toward.z;
        g.strength = vfloat(1.0F);
        set_sheen(g, vfloat(a.alpha), vint(0), pointer<float>(const_cast<float*>(a.albedos)), vmask(true));
        vvec light = load_three(a.light, a.count, i);
        SheenPart part = sheen_part(g, s, light, light.z, vmask(true));
        store_vector(pointer<float>(a.reflected + i), part.reflected);
        store_vector(pointer<float>(a.kept + i), part.kept);
    }
}

} // namespace razor::test::ISA_TARGET
