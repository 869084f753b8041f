// Catmull-Clark surfaces again, in double and by their definition: cages whose every edge has two faces,
// divided a few times, then moved to the limit. Creases (DeRose, Kass & Truong, Subdivision Surfaces in
// Character Animation, 1998) are infinitely sharp, of 10 or more, where they may meet and end in corners of
// three or more, or closed lines without others: no sharper than there are divisions. Nothing here is shared
// with the renderer.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace razor::test {

struct PlainQuads {
    std::vector<glm::dvec3> points;        // on the limit surface
    std::vector<std::array<int, 4>> faces; // 4^(times - 1) for each corner of each face of the cage, in order
    // Of each corner of these: unit, and each side's own on sharp creases; straight in each face of the cage
    // (FaceVaryingInterpolation::all), 0 where it has none.
    std::vector<std::array<glm::dvec3, 4>> normals;
    std::vector<std::array<glm::dvec2, 4>> texcoords;
};

/// `times`: at least 1.
PlainQuads plain_limit(const Mesh& cage, int times);

} // namespace razor::test
