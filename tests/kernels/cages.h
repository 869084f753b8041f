// Small scenes for the tests of the kernels: cages made here, real ones from RAZOR_SHARED_SCENES.
#pragma once

#include "razor/scene/scene.h"

#include <optional>
#include <string>

namespace razor::test {

Mesh cube_cage();
/// `rings` x `sides` quads, a closed surface; radii 1 and 0.4.
Mesh torus_cage(int rings, int sides);
/// Closed, with pentagons and extraordinary points.
Mesh urchin_cage();
/// Squeezed along the axes and jittered, so that neighbouring edges differ in length by powers of two. Stays
/// closed.
Mesh stretched(Mesh mesh);
/// A cube whose top is 1/32 of its bottom: a side of many blocks has an exponent of its own that is five
/// less.
Mesh tapered_cage();
/// A closed box of triangles with narrow bevels, as architecture is modelled: large faces beside slivers.
Mesh bevelled_slab();
/// As bilinear patches, most of them not planar once jittered.
Mesh bilinear(Mesh mesh);
/// Nothing where the shared scenes are not there.
std::optional<Mesh> shared_mesh(const std::string& path_below_scenes);

/// One mesh before a camera, lit, 32 x 32 pixels. `edges_across`: target edges over the mesh's diagonal.
Scene scene_of(const Mesh& mesh, double edges_across);
/// A mesh drawn six times apart from each other: as it is, moved, turned, mirrored, stretched and sheared,
/// and in a nested group.
Scene instances_of(const Mesh& mesh, double edges_across);
Scene small_default_scene(int width, int height);

/// Every edge has two faces.
bool is_closed(const Mesh& mesh);

struct NamedScene {
    std::string name;
    Scene scene;
    bool closed = false;
};
/// The scenes that rays are compared on; shared ones only where they are there.
std::vector<std::string> scene_names();
/// Those of one mesh that is drawn once, where its points lie.
std::vector<std::string> single_mesh_scenes();
/// Nothing for a shared mesh that is not there.
std::optional<NamedScene> named_scene(const std::string& name);

} // namespace razor::test
