// The scene graph as its author states it: groups of placements of meshes and of other groups. A group is
// stated once and may be placed many times. Only local transforms live here; flatten() derives world ones.
#pragma once

#include "razor/scene/graph/affine.h"

#include <string>
#include <vector>

namespace razor {

/// One mesh or group put somewhere, once or as a regular array. Copy (i, j, k) of an array stands at
/// translation + (i, j, k) spacing: spacing is in the parent's units and not turned or scaled by `local`.
struct Placement {
    std::string name; // for messages
    int mesh = -1;    // index into Scene::meshes, or -1: a group
    int group = -1;   // index into SceneGraph::groups, or -1: a mesh
    Transform local;
    glm::ivec3 copies{1, 1, 1}; // positive
    glm::dvec3 spacing{0, 0, 0};
    /// Added to those of all groups above. Each step doubles the target edge length.
    int level_offset = 0;
    /// Multiplied with those of all groups above: factor on the target edge length, before it is rounded to a
    /// power of two. 2: edges twice as long.
    double rate = 1;
    int material = -1; // of all below that states none of its own placement; -1: as above, or the mesh's
};

struct Group {
    std::string name; // for messages
    std::vector<Placement> placements;
};

struct SceneGraph {
    std::vector<Group> groups; // the first is what is drawn
};

/// `graph`, or where it has no groups one that draws each of so many meshes once, where its points lie.
SceneGraph drawn_graph(const SceneGraph& graph, std::size_t meshes);

/// Groups that contain each other, in a circle, each holding the next and the last the first; or nothing.
std::vector<int> find_cycle(const SceneGraph& graph);

} // namespace razor
