// A tree over lights to choose them by: Conty Estevez & Kulla, Importance Sampling of Many Lights with
// Adaptive Tree Splitting, HPG 2018, with the bounds that pbrt-4 keeps of emission.
#pragma once

#include "razor/frame/light_node.h"
#include "razor/scene/light.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace razor {

/// Whether a light is somewhere: others are not chosen from, but each sampled.
bool has_place(const Light& light);

/// Of lights that all have a place, numbered as they are given. `origin`: of scene coordinates.
std::vector<LightNode> light_tree(std::span<const Light> lights, const glm::dvec3& origin);

} // namespace razor
