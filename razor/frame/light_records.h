// Lights as the kernels want them.
#pragma once

#include "razor/frame/layout.h"
#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <optional>

namespace razor {

inline void put(float (&to)[3], const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        to[i] = static_cast<float>(v[i]);
}

/// Side of the square that each sample of a domain has to itself, times edge_pixels: all that a pixel takes
/// share the domain.
float sample_spacing(const Settings& s, double domain, int samples);

/// All but the dimension. Nothing for a light that lights nothing. `origin`: of scene coordinates.
std::optional<LightRecord> light_record(const Light& light, const Settings& s, const glm::dvec3& origin);

} // namespace razor
