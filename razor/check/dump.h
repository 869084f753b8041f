// A built frame as the triangles that rays meet, read from frame memory on the host: for oracles and checks.
// All of it is in the frame's unit (Frame::unit).
#pragma once

#include "razor/frame/frame.h"

#include <array>
#include <vector>

namespace razor::check {

using Point = std::array<float, 3>;

/// The edge whose side of it decides about rays: the triangle's own, or the longer flat one on which it lies.
struct FlatEdge {
    Point from{}, to{};
    int hang = 0; // log2 of the triangle's edges on it
};

struct Triangle {
    int patch = 0, number = 0; // as TraceArguments name them
    int instance = 0;
    std::array<Point, 3> vertex{};
    std::array<FlatEdge, 3> edge{}; // 0 -> 1, 1 -> 2, 2 -> 0
};

/// One block of a grid.
struct BlockView {
    const BlockHeader* header = nullptr;
    const float* words = nullptr; // the same address

    Point vertex(int i) const; // by its number
    /// Vertex i along a side, and the number of segments of the side.
    Point along(int side, int i) const;
    int segments(int side) const;
    /// What decides about sub-edge i -> i+1 of a side, in that direction.
    FlatEdge ancestor(int side, int i) const;
};

/// What the patch of this number is, and the instance it is of.
const PatchRecord& patch_record(Frame& frame, int patch);
const InstanceRecord& instance_of(Frame& frame, int patch);

/// The block at a line of the grids.
BlockView block_at(Frame& frame, int line);

/// The blocks of a patch at a level, row by row, as far as they are there; they may have no vertices yet.
std::vector<BlockView> known_blocks_of(Frame& frame, int patch, int tree = 0, int level = 0);

/// Those of them that are made.
std::vector<BlockView> blocks_of(Frame& frame, int patch, int tree = 0, int level = 0);

/// Appends a block's triangles.
void add_triangles(const BlockView& block, std::vector<Triangle>& out);

/// All triangles of all blocks of opened patches that are made.
std::vector<Triangle> triangles_of(Frame& frame, int tree = 0);

} // namespace razor::check
