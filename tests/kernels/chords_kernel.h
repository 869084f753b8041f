// razor/kernels/chords.h, once a target, for its tests.
#pragma once

#include <cstdint>

namespace razor::test {

struct ChordArguments {
    float* x = nullptr; // vertices: x[stride], y, z
    int stride = 0, quads_u = 0, quads_v = 0;
    float sway = 0;
    float normal[3] = {}, slope = 0; // results
};

} // namespace razor::test
