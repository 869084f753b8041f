// razor/kernels/near_hits.h, once a target, for its tests.
#pragma once

#include <cstdint>

namespace razor::test {

/// Of RAZOR_WIDTH hits.
struct NearHitsArguments {
    const float* place = nullptr;      // x[RAZOR_WIDTH], y, z
    const std::int32_t* hit = nullptr; // of each 0 or 1
    std::int32_t* order = nullptr;     // result: RAZOR_WIDTH lanes
};

} // namespace razor::test
