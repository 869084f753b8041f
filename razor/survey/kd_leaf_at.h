// Where in the kd-tree a ray ended.
#pragma once

#include "razor/frame/frame.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace razor {

/// A leaf of the tree, by the way to it.
struct KdLeaf {
    int depth = -1; // planes passed; -1: no leaf
    int finer = 0;  // how often it went on to the finer blocks of a cell
};

/// Of a worker's tree, the leaf that lists the block at line `block` and whose cell holds the point (scene
/// coordinates), or is no further from it than positions are rounded by. If none lists it, as where a block
/// was met beyond the cell that led to it, the last on the point's own way.
KdLeaf kd_leaf_at(const FrameHeader& frame, int worker, const glm::vec3& point, std::int32_t block);

} // namespace razor
