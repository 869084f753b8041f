#include "tests/kernels/near_hits_kernel.h"

#include "razor/kernels/near_hits.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

void order_hits(NearHitsArguments& a);
void order_hits(NearHitsArguments& a) {
    vvec place;
    place.x = load_vector(pointer<const float>(a.place));
    place.y = load_vector(pointer<const float>(a.place + isa::width));
    place.z = load_vector(pointer<const float>(a.place + 2 * isa::width));
    vmask hit = load_vector(pointer<const std::int32_t>(a.hit)) != vint(0);
    store_vector(pointer<std::int32_t>(a.order), near_order(place, hit));
}

} // namespace razor::test::ISA_TARGET
