// The laid out graph as a frame opens it: a tree of boxes with few children a node, so that a ray never has
// to look at all of a wide group. Wide groups and arrays are halved, along the widest extent of their
// members' centres, until no node has more children than it may; groups of one member and empty ones are left
// out.
#pragma once

#include "razor/scene/graph/flatten.h"

namespace razor {

struct HierarchyNode {
    Box bounds; // world space; of all below
    std::int32_t first_child = 0, child_count = 0;
    std::int32_t instance = -1; // of a leaf; else -1
};

inline constexpr int most_children = 8; // a power of two

/// Node 0 is the root. Parents come before children, and children of one node are consecutive. `drawn`: which
/// instances there is anything to see of; one at least.
std::vector<HierarchyNode> build_hierarchy(const FlatGraph& flat, const std::vector<bool>& drawn);

} // namespace razor
