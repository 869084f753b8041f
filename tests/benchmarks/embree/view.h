// Camera, lights and sky as the baseline's kernels want them.
#pragma once

#include "razor/scene/scene.h"
#include "tests/benchmarks/embree/records.h"

#include <glm/vec3.hpp>

#include <vector>

namespace razor::baseline {

/// `origin`: of scene coordinates.
FrameView view_of_scene(const Scene& scene, const glm::dvec3& origin);
/// Those that light anything.
std::vector<LightSource> lights_of_scene(const Scene& scene, const glm::dvec3& origin);

} // namespace razor::baseline
