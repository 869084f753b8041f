// Directions of any length.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace razor {

/// Unit also where squares of its components are too small or too large. `v`: not 0.
inline glm::dvec3 unit_vector(const glm::dvec3& v) {
    return glm::normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

} // namespace razor
