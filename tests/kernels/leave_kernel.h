// razor/kernels/leave.h, once a target, for its tests.
#pragma once

#include "razor/frame/layout.h"

namespace razor::test {

/// A packet of RAZOR_WIDTH rays that leave hits; arrays of three are x[RAZOR_WIDTH], y, z.
struct LeaveArguments {
    FrameHeader* frame = nullptr;
    WorkerRecord* self = nullptr; // its next field
    float* packets = nullptr;     // scratch, packet_floats: the fields that are kept from packet to packet
    bool forget = false;          // these first
    const float *position = nullptr, *target = nullptr, *wanted = nullptr;
    const std::int32_t* hit = nullptr; // 0: nothing was, and no ray leaves
    float *origin = nullptr, *radius = nullptr, *base = nullptr, *growth = nullptr; // results: fields
    std::int32_t* number = nullptr;
};

} // namespace razor::test
