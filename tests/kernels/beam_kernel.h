// razor/kernels/beam.h, once a target, for its tests.
#pragma once

#include "razor/frame/layout.h"

namespace razor::test {

/// A group of RAZOR_WIDTH rays, long along `axis`, from `origin` for `t_max`; arrays of three are
/// x[RAZOR_WIDTH], y, z.
struct BeamArguments {
    FrameHeader* frame = nullptr; // its reach
    float* packets = nullptr;     // scratch, packet_floats
    const float *origin = nullptr, *direction = nullptr, *t_max = nullptr;
    int axis = 0;
    /// RAZOR_WIDTH boxes, low x[RAZOR_WIDTH], y, z, high x, y, z, in coordinates less `shift`, and widened.
    const float* boxes = nullptr;
    float shift[3] = {}, widen = 0;
    std::int32_t* met = nullptr; // result: of each box, whether the beam meets it
    float plane = 0;             // across plane_axis
    int plane_axis = 0;
    int low = 0, high = 0; // results: whether all of the beam is on that side
};

} // namespace razor::test
