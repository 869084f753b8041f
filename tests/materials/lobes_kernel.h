// razor/kernels/microfacet.h over arrays, once a target, for its tests.
#pragma once

namespace razor::test {

/// Arrays of `count` floats, a multiple of the width; directions as three of them, z along the normal.
struct LobeArrays {
    int count = 0;
    float alpha = 0;
    float view[3] = {}; // unit, above the surface
    float *square_u = nullptr, *square_v = nullptr;
    float* light = nullptr; // directions whose density is asked for
    // Results.
    float* reflected = nullptr;           // for each point of the square: where the view is reflected
    float* density = nullptr;             // of `light`, by solid angle
    float* reflectance = nullptr;         // D V of view and light
    float* reverse_reflectance = nullptr; // with both exchanged
};

} // namespace razor::test
