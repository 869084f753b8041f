#include "tests/kernels/quarters_kernel.h"

#include "razor/kernels/light.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

void quarter(QuarterArguments& a);
void quarter(QuarterArguments& a) {
    Context c;
    c.packets = pointer<float>(a.packets);
    vint pixel = load_vector(pointer<const std::int32_t>(a.pixel));
    vint first = load_vector(pointer<const std::int32_t>(a.first));
    for (int k = 0; k < a.samples; ++k) {
        const int at = k * isa::width;
        Dealt dealt = dealt_point(c, pixel, first, sint(k), sint(a.samples), sint(a.dimension));
        store_vector(pointer<float>(a.dealt_u + at), dealt.at.u);
        store_vector(pointer<float>(a.dealt_v + at), dealt.at.v);
        store_vector(pointer<std::int32_t>(a.number + at), dealt.number);
        vpoint own = sample_square(pixel, first + vint(k), sint(a.dimension));
        store_vector(pointer<float>(a.own_u + at), own.u);
        store_vector(pointer<float>(a.own_v + at), own.v);
    }
    vvec place;
    place.x = load_vector(pointer<const float>(a.place));
    place.y = load_vector(pointer<const float>(a.place + isa::width));
    place.z = load_vector(pointer<const float>(a.place + 2 * isa::width));
    vmask hit = load_vector(pointer<const std::int32_t>(a.hit)) != vint(0);
    vmask fine = load_vector(pointer<const std::int32_t>(a.fine)) != vint(0);
    sbool pays = quarters_pay(place, hit, fine, sfloat(a.extent));
    std::int32_t word = 0;
    store(pointer<std::int32_t>(&word), select(pays, sint(1), sint(0)));
    a.pays = word;
}

void extent(ExtentArguments& a);
void extent(ExtentArguments& a) {
    Context c;
    c.frame = pointer<FrameHeader>(a.frame);
    store(pointer<float>(&a.extent), extent_of(c, pointer<LightRecord>(a.light)));
}

} // namespace razor::test::ISA_TARGET
