// Layers of a frame that was rendered: one ray through the centre of each pixel, with a lens from its middle,
// asks for what the frame's camera rays ask for; and what the frame's own rays cost, tile by tile. The
// picture's other planes stay as they are, and ordinary frames pay nothing.
//
// Rays go in packets of pixels that lie together, 8 x 4 of them for 32 lanes, within screen tiles, as a
// frame's of one sample a pixel. Where workers have trees of their own, it is worker 0's that is looked at,
// and what of it no ray has asked for yet is built. What is hit is the same whoever rendered the frame, as
// are tiles' figures but their times; a tree's boxes, and with them the steps that packets take, depend on
// which of the frame's rays came first.
#pragma once

#include "razor/frame/frame.h"
#include "razor/survey/layers.h"

#include <atomic>
#include <cstdint>
#include <functional>

namespace razor {

/// Bytes of the lines that tracing touched, each line once.
struct TouchedBytes {
    std::int64_t all = 0, tree = 0, grids = 0;
};
/// Traces a packet as Frame::see() does, and tells.
using TouchMeter = std::function<TouchedBytes(Frame& frame, const SeeArguments& packet)>;

struct SurveyOptions {
    LayerSet layers;
    /// Those that rendered the frame, for layers by tile; else any.
    const KernelTable* kernels = nullptr;
    TouchMeter touched;                        // for LayerGroup::bytes
    const std::atomic<bool>* cancel = nullptr; // set to true from anywhere: ends early
};

/// Adds the layers to the film of the part of the picture that the frame's settings crop it to. For layers by
/// tile the frame must have been made with FrameOptions::tile_costs and rendered since its last reset().
/// False: cancelled, and the film is not whole.
bool survey(Frame& frame, const Crop& part, const SurveyOptions& options, Film& film);

} // namespace razor
