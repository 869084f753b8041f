// The laid out instances as a frame opens them: a tree of boxes with few children a node, so that a ray never
// has to look at all of a wide group. It is a function of the instances' boxes alone: those of like size
// share an octree over their boxes' centres, without the levels at which nothing is told apart, and the
// octrees of all sizes hang together by size in the same way. So it can be kept from moment to moment and
// only what moved be touched, and yet be the tree that the moment alone gives: a box that stays in its cell
// moves the boxes above it, one that leaves it is taken out and put in elsewhere, and no order of moves
// leaves a trace. Nor can it become worse than a new one.
#pragma once

#include "razor/scene/graph/box.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace razor {

struct HierarchyNode {
    Box bounds; // world space; of all below
    std::int32_t first_child = 0, child_count = 0;
    std::int32_t instance = -1; // of a leaf; else -1

    bool operator==(const HierarchyNode&) const = default;
};

inline constexpr int most_children = 8;

/// Cells of the octrees: 2^21 along each axis, from origin - 2^exponent to origin + 2^exponent. Both stay as
/// they are while what they hold moves a little.
struct HierarchyGrid {
    /// The centre of the box, rounded to an eighth of its largest extent (both to powers of two).
    explicit HierarchyGrid(const Box& all);
    glm::dvec3 origin{0};
    int exponent = 0;

    bool operator==(const HierarchyGrid&) const = default;
};

class Hierarchy {
public:
    struct Moved {
        std::int32_t instance = 0;
        Box bounds;
    };

    Hierarchy() = default;
    /// boxes: of each instance. drawn: which there is anything to see of; one at least.
    Hierarchy(std::span<const Box> boxes, const std::vector<bool>& drawn);

    /// Gives instances other boxes. False where the grid is another now: then a new one must take this one's
    /// place.
    bool move(std::span<const Moved> moved);

    const HierarchyGrid& grid() const { return grid_; }
    const Box& bounds() const { return nodes_.front().bounds; }
    /// Node 0 is the root; the children of a node lie side by side, in blocks of most_children. Nodes that
    /// are nobody's children are as HierarchyNode{} is. At most node_limit() of as many instances.
    const std::vector<HierarchyNode>& nodes() const { return nodes_; }
    static std::size_t node_limit(std::size_t instances) { return 1 + most_children * instances; }
    /// Nodes that are other ones than when this was last asked, in order; of a new one all.
    std::vector<std::int32_t> take_touched();

private:
    /// Octal digits: of the size, of the cell, of the instance's number.
    struct Key {
        std::uint64_t cell = 0; // 63 bits: x, y and z of each level in turn
        std::uint32_t size = 0, instance = 0;

        int digit(int n) const;
    };
    static constexpr int size_digits = 4, cell_digits = 21, instance_digits = 8,
                         digits = size_digits + cell_digits + instance_digits;
    static int first_difference(const Key& a, const Key& b);

    /// Where the children of an inner node lie. All below have the first `depth` digits of the key, and
    /// differ in the next one.
    struct Block {
        std::int32_t owner = 0; // the node whose children these are; -1: nobody's
        int depth = 0;
        Key key;
        bool open = false; // boxes above are to be made anew
    };

    Key key_of(std::int32_t instance, const Box& box) const;
    std::int32_t block_at(std::int32_t node) const {
        return (nodes_[at(node)].first_child - 1) / most_children;
    }
    static std::int32_t block_of(std::int32_t node) { return (node - 1) / most_children; }
    static std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }
    const Key& key_at(std::int32_t node) const;
    std::int32_t new_block(std::int32_t owner, int depth, const Key& key);
    void put(std::int32_t node, const HierarchyNode& value);
    void touch(std::int32_t node);
    void open(std::int32_t block);
    void insert_child(std::int32_t node, const HierarchyNode& child, const Key& key);
    void insert(std::int32_t instance, const Box& box);
    void remove(std::int32_t instance);
    void refit();

    HierarchyGrid grid_{Box{}};
    std::vector<HierarchyNode> nodes_;
    std::vector<Block> blocks_;
    std::vector<std::int32_t> free_blocks_;
    std::vector<Key> keys_;                              // of each instance
    std::vector<std::int32_t> node_of_;                  // of each instance; -1: not drawn
    std::array<std::vector<std::int32_t>, digits> open_; // blocks by depth
    std::vector<bool> is_touched_;
    std::vector<std::int32_t> touched_;
};

} // namespace razor
