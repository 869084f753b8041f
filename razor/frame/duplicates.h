// What several kd-trees of one frame have both built.
#pragma once

#include <cstdint>

namespace razor {

/// How often each was built beyond the first time: what one tree for all would have saved. Nodes and blocks
/// are the same where they cover the same cell, or the same part of a patch at the same level.
struct Duplicates {
    std::int64_t nodes = 0;   // split, or leaves
    std::int64_t patches = 0; // opened
    std::int64_t blocks = 0;  // whose vertices were made
    std::int64_t normals = 0; // blocks whose normals were
};

} // namespace razor
