#include "tests/materials/sheen_kernel.h"

#include "razor/kernels/sheen.h"

#include <type_traits>

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
    SheenRecord record{};
    if (a.rows != nullptr) {
        record.first_root = a.rows->first_root;
        record.per_root = a.rows->per_root;
        record.last_row = static_cast<float>(a.rows->last);
    }
    Sheens of{pointer<SheenRecord>(&record), vint(0), vmask(true)};
    pointer<float> albedos(const_cast<float*>(a.albedos));
    for (int i = 0; i < a.count; i += isa::width) {
        const auto respond = [&](const vfloat& alpha, const auto& rows) {
            Cloth<std::decay_t<decltype(rows)>> g;
            g.toward = load_three(a.view, a.count, i);
            g.view = g.toward.z;
            g.strength = vfloat(1.0F);
            set_sheen(g, alpha, rows, albedos, vmask(true));
            vvec light = load_three(a.light, a.count, i);
            SheenPart part = sheen_part(g, s, light, light.z, vmask(true));
            store_vector(pointer<float>(a.reflected + i), part.reflected);
            store_vector(pointer<float>(a.kept + i), part.kept);
        };
        if (a.rows == nullptr) {
            respond(vfloat(a.alpha), OneRow{vint(0)});
            continue;
        }
        vfloat roughness = load_vector(pointer<float>(a.roughness + i));
        respond(roughness * roughness, rows_beside(of, vint(0), roughness));
    }
}

} // namespace razor::test::ISA_TARGET
