// Layers of what screen tiles cost.
#pragma once

#include "razor/frame/frame.h"
#include "razor/survey/layers.h"

namespace razor {

/// Adds them to the film of a part of the picture: per pixel of the tile, or of its packets of `width` lanes.
void add_tile_layers(const std::vector<TileCost>& costs, const FrameHeader& frame, int width,
                     const Crop& part, const LayerSet& layers, Film& film);

} // namespace razor
