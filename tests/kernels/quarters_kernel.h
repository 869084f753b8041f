// razor/kernels/quarters.h, once a target, for its tests.
#pragma once

#include "razor/frame/layout.h"

namespace razor::test {

/// Of RAZOR_WIDTH hits; arrays of three are x[RAZOR_WIDTH], y, z.
struct QuarterArguments {
    float* packets = nullptr; // scratch, packet_floats
    const std::int32_t *pixel = nullptr, *first = nullptr;
    int samples = 0, dimension = 0;
    float *dealt_u = nullptr, *dealt_v = nullptr; // results: samples x RAZOR_WIDTH, as they are dealt ...
    std::int32_t* number = nullptr;               // ... and which of each four they are ...
    float *own_u = nullptr, *own_v = nullptr;     // ... and of the sequence
    const float* place = nullptr;                 // three
    const std::int32_t *hit = nullptr, *fine = nullptr; // of each hit 0 or 1
    float extent = 0;
    int pays = 0; // result
};

/// How far apart points of a light are.
struct ExtentArguments {
    FrameHeader* frame = nullptr; // its reach
    LightRecord* light = nullptr;
    float extent = 0; // result
};

} // namespace razor::test
