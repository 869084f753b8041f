// What a tree with a memory budget holds, or is about to drop.
#pragma once

#include "razor/frame/budget.h"

#include <cstdint>
#include <vector>

namespace razor {

/// Keys tell what is the same in several trees, or was made again after it was dropped: nodes on the same way
/// from the root (128 bits hashed to 64), patches, and blocks of the same part of a patch at the same level.
struct Inventory {
    std::vector<std::uint64_t> nodes;   // split, or leaves
    std::vector<std::uint64_t> patches; // opened
    std::vector<std::uint64_t> blocks;  // whose vertices are made
    std::vector<std::uint64_t> normals; // whose normals are
    std::int64_t inner_nodes = 0, leaves = 0, unsplit_nodes = 0;
    std::int64_t grid_bytes = 0, node_bytes = 0, list_bytes = 0;
};

/// In an epoch before all: what was used then or before is nothing.
inline constexpr std::int32_t before_all = -1;

/// What was last used in epoch `last` or before, and what was used since; nobody may be at work in the tree.
struct Inventories {
    Inventory old, used;
};
Inventories take_inventory(const FrameHeader& header, int tree, std::int32_t last);

} // namespace razor
