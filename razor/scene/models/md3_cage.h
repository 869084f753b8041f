// One cage of an MD3 model's triangles: points that the format has split are joined again.
#pragma once

#include "razor/scene/models/md3_reader.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace razor {

/// What a file holds, one surface after the other. A vertex is a texture coordinate and a point in every
/// frame.
struct Md3Triangles {
    std::size_t frame_count = 0; // one or more
    std::vector<glm::vec2> texcoords;
    /// Coordinates in 1/64 unit: x, y, z of the first vertex in frame 0, in frame 1 ..., then the next
    /// vertex.
    std::vector<std::int16_t> steps;
    std::vector<glm::vec3> normals; // of each vertex in frame 0, unit; empty: not read
    std::vector<int> corners;       // vertices, three a triangle, counter-clockwise seen from outside
    std::vector<int> surfaces;      // of each triangle the number of its surface
};

/// The cage, without a name, and its frames as razor/scene/models/md3_reader.h describes them. Without a face
/// if no triangle keeps three distinct corners. `crease_degrees`: see hard_edges.h.
Md3Model join(const Md3Triangles& triangles, double crease_degrees);

} // namespace razor
