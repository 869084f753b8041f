// Hard edges of models that know no creases: where their files split points because normals differ.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace razor {

/// No angle between normals is larger: nothing is hard.
inline constexpr double no_crease_angle = 180;

/// Infinitely sharp creases where faces meet at an edge whose corners have normals that differ by more than
/// `degrees` at one of its ends, or both: a crease's last edge has one normal where it ends. In order of
/// their points, the lower first. `triangles`: points, joined, three a face; `normals`: of each corner, of
/// any length; those without length are like any other. Edges of one face are none.
std::vector<Crease> hard_edges(const std::vector<int>& triangles, const std::vector<glm::vec3>& normals,
                               double degrees);

} // namespace razor
