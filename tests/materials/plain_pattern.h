// Patterns in double precision, by their definitions (razor/scene/texture.h; Perlin, "Improving Noise",
// 2002). Nothing here is shared with the kernels.
#pragma once

#include "razor/scene/texture.h"

#include <glm/vec3.hpp>

namespace razor::test {

/// In [0, 1], as nothing but points sees it. `q`: in cells.
double plain_value(const Pattern& pattern, const glm::dvec3& q);

} // namespace razor::test
