// Rays of cameras (razor/scene/scene.h), in double and by their definitions.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace razor::test {

struct PlainRay {
    glm::dvec3 origin, direction; // unit
};

/// Through a point of the film, both from -1 to 1, x to the right and y up; `shape`: its width by its height.
/// `lens`: in [0, 1) both ways, by chance, where there is one.
PlainRay plain_camera_ray(const Camera& camera, double shape, const glm::dvec2& film, const glm::dvec2& lens);

} // namespace razor::test
