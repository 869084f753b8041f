// One point of a floor, looked at from a given angle: scenes that closed forms and integrals can be written
// for.
#pragma once

#include "razor/native/render.h"

#include <glm/vec3.hpp>

#include <string>

namespace razor::test {

/// A floor of 200 x 200 about the origin, y up, no light, and a camera all of whose 8 x 8 pixels look at the
/// origin from 10 away at so many degrees from the normal.
Scene seen_floor(const Material& material, double degrees);

/// Towards that camera, with the floor's normal as z axis and the camera above the x axis.
glm::dvec3 view_at(double degrees);

/// A direction or point of that system, in the scene's.
inline glm::dvec3 to_scene(const glm::dvec3& p) {
    return {p.x, p.z, -p.y};
}

/// Over all pixels; `spread`, if given, receives the standard error of each component.
glm::dvec3 mean_colour(const Scene& scene, const std::string& target, glm::dvec3* spread = nullptr);

} // namespace razor::test
