// Where the scene lies: origins in double precision, bounds, reach, target edge lengths.
#pragma once

#include "razor/scene/graph/hierarchy.h"
#include "razor/scene/scene.h"

#include <span>
#include <vector>

namespace razor {

/// One mesh where the scene draws it: p -> linear p + offset takes mesh coordinates (points minus the mesh's
/// origin) to the instance's own, which are scene coordinates minus `origin`.
struct Instance {
    int mesh = 0;
    int material = 0;
    glm::dmat3 linear{1};
    glm::vec3 offset{0}; // what rounding the origin left over
    glm::vec3 origin{0}; // the mesh's, in scene coordinates
    /// Target, world units: a power of two in the mesh's own, times the scale.
    double edge_length = 0;
    double mesh_edge_length = 0; // the same in the mesh's units

    bool moved() const { return linear != glm::dmat3(1) || offset != glm::vec3(0); }
};

/// The scene's graph laid out, as of flatten(); messages begin with the scene's name.
FlatGraph lay_out(const Scene& scene, std::span<const Box> mesh_bounds);

struct SceneGeometry {
    glm::dvec3 origin; // of scene coordinates: the centre of everything
    std::vector<glm::dvec3> mesh_origins;
    std::vector<Instance> instances;
    std::vector<HierarchyNode> graph;
    double reach = 0; // no two points of scene and camera are further apart
};

/// The meshes must be valid. `drawn`: which of them have anything to see, one that the graph places at least.
/// Throws UserError as lay_out() does.
SceneGeometry locate_scene(const Scene& scene, const std::vector<bool>& drawn);

/// The power of two nearest to `length` in the logarithm; length > 0.
double nearest_power_of_two(double length);

} // namespace razor
