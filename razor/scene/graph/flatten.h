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
    Box bounds;                 // world space; of all below
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
    double rate = 1;  // product of the rates stated on the way down
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

/// "outer/inner/leaf": the names on the way to a node, for messages.
std::string path_of(const FlatGraph& flat, const SceneGraph& graph, std::int32_t node);

} // namespace razor
