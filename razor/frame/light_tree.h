// A tree over lights to choose them by: Conty Estevez & Kulla, Importance Sampling of Many Lights with
// Adaptive Tree Splitting, HPG 2018, with the bounds that pbrt-4 keeps of emission.
#pragma once

#include "razor/frame/light_bounds.h"
#include "razor/frame/light_node.h"

#include <span>
#include <vector>

namespace razor {

/// Leaves are numbered as the bounds are given; those without power are not in it.
std::vector<LightNode> light_tree(std::span<const LightBounds> lights);

} // namespace razor
