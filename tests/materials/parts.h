// What parts of a picture are in the mean, and how sure that is.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace razor::test {

/// Of 4 x 4 parts of a picture, rows from the top: radiance, and the variance of that mean.
struct Parts {
    std::vector<glm::dvec3> mean = std::vector<glm::dvec3>(16, glm::dvec3(0)), variance = mean;
};

/// Over pictures of so many seeds, from 0 on. `target`: of the kernels.
Parts parts_of(Scene scene, int seeds, const std::string& target = "auto");

} // namespace razor::test
