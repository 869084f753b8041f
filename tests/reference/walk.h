// Stand-in blocks (rule 3): the finest triangulation is not touched where a coarser block is the same
// surface.
//
// A block of level k covers side x side quads of its patch's level k; its four children those of level k-1.
// It may stand in for all its descendants, drawn with its vertices at p_k, exactly if p_k = p_0 for each
// vertex of the finest grid that it covers. That holds where level k-1 (and so every finer one) is gone at
// each vertex that decides those positions:
// - the vertices of the finest grid in the block with index 0 ... k-1,
// - *and their ancestors of index below k, which may lie outside the block*: on a border whose curve is
//   coarser than the patch's grid a vertex has an index below its grid level, and its parents lie as far
//   apart as the curve's edges are long,
// - *and, of a displaced surface, also those of index k and above*: a corner that neighbours see at v_0 is
// not
//   at v_k.
// The box of their anchors decides, by the least footprint over it.
#pragma once

#include "tests/reference/distance.h"
#include "tests/reference/soup.h"
#include "tests/reference/surface.h"

namespace razor::reference {

/// Which anchors a block's box holds.
enum class Anchors {
    deciding, // as above
    finer,    // only the vertices in the block that are born below its level: not enough
};

struct Block {
    Rectangle area;
    Box box;
    std::vector<int> children;
};

class Blocks {
public:
    /// `side`: quads along a block, a power of two.
    Blocks(const Levels& levels, int side, Anchors anchors);

    const std::vector<Block>& blocks() const { return blocks_; }
    const std::vector<int>& roots() const { return roots_; } // each patch's coarsest level
    /// Blocks drawn by a ray's view: those of the highest level that may stand in.
    std::vector<int> cut(const View& view) const;
    const Levels& levels() const { return levels_; }

private:
    int add(const Rectangle& area);
    Box box_of(const Rectangle& area) const;
    const Levels& levels_;
    int side_;
    Anchors anchors_;
    std::vector<Block> blocks_;
    std::vector<int> roots_;
};

/// Least footprint over a box.
double least_footprint(const View& view, const Box& box);

/// The cut's triangles, each block at p_k, with its sides closed.
Soup draw_cut(const Blocks& blocks, const Surface& surface, const std::vector<int>& cut);

} // namespace razor::reference
