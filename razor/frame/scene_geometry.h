// Where the scene lies: origins in double precision, bounds, reach, target edge lengths.
#pragma once

#include "razor/scene/graph/hierarchy.h"
#include "razor/scene/scene.h"
#include "razor/scene/scene_changes.h"

#include <optional>
#include <span>
#include <vector>

namespace razor {

/// One mesh where the scene draws it: p -> linear p + offset takes mesh coordinates (points minus the mesh's
/// origin) to the instance's own, which are scene coordinates minus `origin`.
struct Instance {
    int mesh = 0;
    int material = 0; // -1: each face has its own, see Mesh::face_materials
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

/// A function of the scene as it is at one moment, and of nothing before.
struct SceneGeometry {
    glm::dvec3 origin{0}; // of scene coordinates: about the centre of everything (see HierarchyGrid)
    std::vector<glm::dvec3> mesh_origins;
    std::vector<Instance> instances;
    Hierarchy graph;
    double reach = 0; // no two points of scene and camera are further apart

    // From which follow() goes on.
    FlatGraph flat;
    std::vector<double> displacements;   // of each mesh, at most, in its units: mesh_bounds hold them
    std::vector<Box> mesh_bounds, boxes; // boxes: of the points of each instance, in the world
    std::vector<bool> drawn;             // of each mesh
    std::vector<bool> stands;  // of each instance, whether the graph neither turns, scales nor moves it
    std::vector<int> standing; // of each mesh, how many of its instances do
    Camera camera;             // from which levels of detail are measured
};

/// The meshes must be valid. `drawn`: which of them have anything to see, one that the graph places at least.
/// Throws UserError as lay_out() does.
SceneGeometry locate_scene(const Scene& scene, const std::vector<bool>& drawn);

/// What follow() made others.
struct GeometryChanges {
    std::vector<std::int32_t> instances; // in order
    std::vector<int> meshes;             // with other points, or another origin
};

/// Makes of the geometry of a scene that of the same scene after these changes: what locate_scene() gives,
/// with nothing looked at that did not move (but: where levels of detail are measured from another camera, or
/// all instances of a mesh share one, edge lengths of all instances). Nothing, if all is other: then, as
/// where it throws UserError as lay_out() does, the geometry must be located anew.
std::optional<GeometryChanges> follow(SceneGeometry& geometry, const FlatIndex& index, const Scene& scene,
                                      const SceneChanges& changes);

/// The power of two nearest to `length` in the logarithm; length > 0.
double nearest_power_of_two(double length);

} // namespace razor
