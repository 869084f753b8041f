// razor/kernels/sheen.h over arrays, once a target, for its tests.
#pragma once

#include "razor/frame/sheen_albedo.h"

namespace razor::test {

/// Arrays of `count` floats, a multiple of the width; directions as three of them, z along the normal.
struct SheenArrays {
    int count = 0;
    float alpha = 0;
    const float* albedos = nullptr; // sheen_steps of that alpha
    /// Instead of alpha, as maps say it; then albedos are those of `rows`.
    float* roughness = nullptr;
    const SheenRows* rows = nullptr;
    float* view = nullptr; // unit, above the surface; likewise:
    float* light = nullptr;
    // Results, of the colour 1.
    float *reflected = nullptr, *kept = nullptr;
};

} // namespace razor::test
