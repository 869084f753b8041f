#include "tests/kernels/chords_kernel.h"

#include "razor/kernels/chords.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

void chords(ChordArguments& a);
void chords(ChordArguments& a) {
    svec normal;
    sfloat slope = chord_slope_of(pointer<float>(a.x), sint(a.stride), sint(a.quads_u), sint(a.quads_v),
                                  sfloat(a.sway), normal);
    store_svec(pointer<float>(a.normal), normal);
    store(pointer<float>(&a.slope), slope);
}

} // namespace razor::test::ISA_TARGET
