// The scene graph laid out: every placement that is reached from the root becomes a node of one tree, every
// mesh it ends at an instance. Parents come before children and children of one node are consecutive, so
// world transforms are one pass forwards, bounds one pass backwards, and no depth of nesting needs a stack.
#pragma once

#include "razor/scene/graph/box.h"
#include "razor/scene/graph/graph.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace razor {

struct FlatNode {
    std::int32_t parent = -1;                // -1: the root
    std::int32_t group = -1, placement = -1; // whose local transform it has; -1: none (root, array)
    std::int32_t first_child = 0, child_count = 0;
    std::int32_t instance = -1; // of a leaf; else -1
    glm::dvec3 copy_offset{0};  // of an array's copy, units of the parent
    Affine world;               // to world space
    Box bounds;                 // world space; of all below, but see follow()
};

/// A mesh in the world.
struct FlatInstance {
    std::int32_t node = 0; // its leaf
    std::int32_t mesh = 0;
    std::int32_t material = -1; // -1: the mesh's own
    /// Levels of detail between the world and the mesh: where the world asks for edges of 2^k, the mesh is
    /// diced at 2^(k + level_offset) of its own units. Minus the scale, rounded to a power of two (log2 of
    /// the world matrix's largest singular value, so that under non-uniform scale and shear no edge is
    /// longer than asked), plus the level offsets stated on the way down.
    std::int32_t level_offset = 0;
    std::int32_t stated_level_offset = 0; // those stated alone
    double rate = 1;                      // product of the rates stated on the way down
    double scale = 1; // largest singular value; a power of two exactly if it is one up to rounding
};

struct FlatGraph {
    std::vector<FlatNode> nodes; // 0: the root
    std::vector<FlatInstance> instances;
};

inline constexpr std::int64_t most_instances = std::int64_t{1} << 22;
inline constexpr std::int64_t most_flat_nodes = std::int64_t{1} << 23;

/// `mesh_bounds`: of each mesh's points, in its own units. Throws UserError, naming the way down from the
/// root, for groups that contain each other, too many instances or nodes, and all that refit() refuses.
FlatGraph flatten(const SceneGraph& graph, std::span<const Box> mesh_bounds);

/// Derives world transforms, level offsets and bounds anew, after local transforms changed. Throws UserError
/// for degenerate world transforms and for what lies beyond the coordinates a frame can hold.
void refit(FlatGraph& flat, const SceneGraph& graph, std::span<const Box> mesh_bounds);

/// A placement of a graph: graph.groups[group].placements[placement].
struct PlacementName {
    std::int32_t group = 0, placement = 0;

    bool operator==(const PlacementName&) const = default;
};

/// What became of each placement, and of each mesh.
class FlatIndex {
public:
    FlatIndex(const FlatGraph& flat, const SceneGraph& graph, std::size_t meshes);
    /// Nodes that have its local transform, in order.
    std::span<const std::int32_t> nodes_of(const PlacementName& name) const;
    /// Instances, in order.
    std::span<const std::int32_t> instances_of(std::size_t mesh) const { return list(meshes_, mesh); }

private:
    struct Lists {
        std::vector<std::size_t> first; // list i is items[first[i]] up to first[i + 1]
        std::vector<std::int32_t> items;
    };
    static Lists sorted(std::span<const std::int32_t> list_of, std::size_t lists);
    static std::span<const std::int32_t> list(const Lists& lists, std::size_t i) {
        return std::span(lists.items).subspan(lists.first[i], lists.first[i + 1] - lists.first[i]);
    }

    std::vector<std::size_t> first_placement_; // of each group, in the order of all
    Lists placements_, meshes_;
};

/// What refit() does, for what lies below the placements in `moved`, whose local transforms alone changed,
/// and for instances of these meshes, whose bounds did. Of the others nothing is looked at; so bounds of
/// nodes that are no leaves stay as they were. Returns the instances that have other world transforms or
/// bounds, in order.
std::vector<std::int32_t> follow(FlatGraph& flat, const FlatIndex& index, const SceneGraph& graph,
                                 std::span<const Box> mesh_bounds, std::span<const PlacementName> moved,
                                 std::span<const int> meshes);

/// "outer/inner/leaf": the names on the way to a node, for messages.
std::string path_of(const FlatGraph& flat, const SceneGraph& graph, std::int32_t node);

} // namespace razor
