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

/// A point of an instance's mesh relative to the instance's origin. Relative in double precision too: what is
/// small and far away keeps its shape.
class Placer {
public:
    Placer(const SceneGeometry& geometry, const Instance& instance);
    glm::dvec3 operator()(const glm::dvec3& p) const {
        return moved_only_ ? p + relative_.translation : relative_(p);
    }

private:
    Affine relative_;
    bool moved_only_;
};

/// The power of two nearest to `length` in the logarithm; length > 0.
double nearest_power_of_two(double length);

} // namespace razor
