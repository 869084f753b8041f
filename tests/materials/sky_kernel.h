// razor/kernels/sky_map.h over arrays, once a target, for its tests.
#pragma once

#include "razor/frame/sky_record.h"

namespace razor::test {

/// Arrays of `count` floats, a multiple of the width; directions as three of them.
struct SkyArrays {
    int count = 0;
    SkyRecord* sky = nullptr;
    float *square_u = nullptr, *square_v = nullptr;
    // Results: where samples go, their density as the sampler has it, and the density of that direction.
    float *direction = nullptr, *density = nullptr, *density_there = nullptr;
};

} // namespace razor::test
