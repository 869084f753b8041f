// Where the scene lies: origins in double precision, bounds, reach, target edge lengths.
#pragma once

#include "razor/scene/graph/flatten.h"
#include "razor/scene/scene.h"

#include <vector>

namespace razor {

/// One mesh where the scene draws it.
struct Instance {
    int mesh = 0;
    int material = 0;
    Affine world;           // from the mesh's points to the world
    glm::vec3 origin;       // relative to the scene's; floats, so that the sum is exact in double
    double edge_length = 0; // target, world units: a power of two in the mesh's own, times the scale
};

struct SceneGeometry {
    glm::dvec3 origin; // of scene coordinates: the centre of everything
    std::vector<Instance> instances;
    double reach = 0; // no two points of scene and camera are further apart
};

/// The meshes must be valid. Throws UserError where the graph cannot be laid out (see flatten()).
SceneGeometry locate_scene(const Scene& scene);

/// From the points of an instance's mesh to those relative to the instance's origin. The origin is taken from
/// the translation, not from the points: what is small and far away keeps its shape.
Affine relative_to_origin(const SceneGeometry& geometry, const Instance& instance);

/// The power of two nearest to `length` in the logarithm; length > 0.
double nearest_power_of_two(double length);

} // namespace razor
