// Where the scene lies: origins in double precision, bounds, reach, target edge lengths.
#pragma once

#include "razor/scene/scene.h"

#include <vector>

namespace razor {

struct SceneGeometry {
    glm::dvec3 origin;                   // of scene coordinates: the centre of everything
    std::vector<glm::vec3> mesh_origins; // relative to it, floats, so that the sum is exact in double
    std::vector<double> edge_lengths;    // of each mesh, powers of two
    double reach = 0;                    // no two points of scene and camera are further apart
};

SceneGeometry locate_scene(const Scene& scene);

/// The power of two nearest to `length` in the logarithm; length > 0.
double nearest_power_of_two(double length);

} // namespace razor
