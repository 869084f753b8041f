// The lights of razor/scene/light.h again, in double and by their definitions: shapes by their area, distant
// ones by solid angle. Nothing here is shared with the kernels.
#pragma once

#include "razor/scene/light.h"

#include <glm/vec3.hpp>

namespace razor::test {

/// Light from a point, or a direction, of it that is chosen by chance.
struct PlainLight {
    glm::dvec3 direction{0, 1, 0}; // unit, towards it
    double away = 0;               // infinite, of distant ones
    glm::dvec3 irradiance{0}; // of what faces it, by the chance of the choice; 0: from there it is not seen
};

/// `s`, `t`: in [0, 1), by chance.
PlainLight choose_of_light(const Light& light, const glm::dvec3& from, double s, double t);

/// The radiance that the ray finds of it where nothing else is met before `end`.
glm::dvec3 met_light(const Light& light, const glm::dvec3& origin, const glm::dvec3& direction, double end);

} // namespace razor::test
