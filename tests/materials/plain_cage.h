// Catmull-Clark surfaces again, in double and by their definition: cages without creases whose every edge has
// two faces, divided a few times, then moved to the limit. Nothing here is shared with the renderer.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace razor::test {

struct PlainQuads {
    std::vector<glm::dvec3> points, normals; // on the limit surface; unit
    std::vector<std::array<int, 4>> faces; // 4^(times - 1) for each corner of each face of the cage, in order
};

/// `times`: at least 1.
PlainQuads plain_limit(const Mesh& cage, int times);

} // namespace razor::test
