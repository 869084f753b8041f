#include "tests/materials/sky_kernel.h"

#include "razor/kernels/sky_map.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

void sky(const SkyArrays& a);
void sky(const SkyArrays& a) {
    pointer<SkyRecord> record(a.sky);
    for (int i = 0; i < a.count; i += isa::width) {
        vfloat u = load_vector(pointer<float>(a.square_u + i));
        vfloat v = load_vector(pointer<float>(a.square_v + i));
        SkySample s = sample_sky_direction(record, {u, v}, vmask(true));
        pointer<float> out(a.direction + i);
        store_vector(out, s.direction.x);
        store_vector(out + a.count, s.direction.y);
        store_vector(out + 2 * a.count, s.direction.z);
        store_vector(pointer<float>(a.density + i), s.density);
        SkyPlace place = place_in_sky(record, s.direction);
        store_vector(pointer<float>(a.density_there + i), sky_density(record, place, vmask(true)));
    }
}

} // namespace razor::test::ISA_TARGET
