// Where the vertices of a block can be found by any ray that asks for it: the box with which it is listed.
#pragma once

#include "razor/kernels/corners.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// How far a corner of the block that is the middle of an edge moves where target edge lengths are `target`.
inline sfloat middle_moves(const Context& c, pointer<BlockHeader> block, sfloat target) {
    sfloat most = load(field(block, &BlockHeader::middle_sway));
    if (branch(most == 0.0F))
        return 0.0F;
    sint patch = load(field(block, &BlockHeader::patch));
    sint line = load(field(c.open + patch, &OpenPatch::root));
    pointer<BlockHeader> root = as<BlockHeader>(c.grids + line);
    sint first = birth_of_middle(root, 0);
    sint birth = min(first, birth_of_middle(root, 1));
    return select(target < moving_from(birth), sfloat(0.0F), most);
}

/// How far the corners of a block move along any axis where target edge lengths are at most `target`: each
/// towards others of its parent, as far as those lie off, and with the parent's own corners.
inline sfloat corners_move(const Context& c, pointer<BlockHeader> block, sfloat target) {
    sfloat sum = middle_moves(c, block, target);
    for (;;) {
        sint parent = load(field(block, &BlockHeader::parent));
        if (branch(parent < 0))
            break;
        if (branch(target < moving_from(birth_of_corners(block))))
            break;
        sum = sum + load(field(block, &BlockHeader::corner_sway));
        block = as<BlockHeader>(c.grids + parent);
        sfloat all = load(field(block, &BlockHeader::sway) + (blend_passes - 1));
        sfloat own = load(field(block, &BlockHeader::sway) + (blend_passes - 2));
        sum = sum + (all - own);
        sum = sum + middle_moves(c, block, target);
    }
    return sum;
}

/// Where corners of blocks can be where target edge lengths are at most `target`, in boxes: at their anchors,
/// if they move at the means of where others can be, or between.
struct CornerReach {
    static constexpr int words = 6;
    sfloat target;

    /// What a corner hangs from may lie further off than all of the block.
    sbool at_rest(pointer<BlockHeader> block, sint birth) const {
        sfloat most = target;
        sint ancestors_at = load(field(block, &BlockHeader::ancestors_at));
        if (branch(ancestors_at != 0))
            most = coarsest_around(block);
        return most < moving_from(birth);
    }
    /// Corners of coarser blocks lie further off.
    void climb(pointer<BlockHeader> block) { target = min(coarsest_around(block), unbounded_target); }
    sfloat coarsest_around(pointer<BlockHeader> block) const {
        pointer<float> box = box_with_ancestors(block);
        svec low = load_svec(box);
        svec high = load_svec(box + 3);
        return coarsest_target(target, high - low);
    }
    Box place(const svec& anchor) const { return {anchor, anchor}; }
    static Box load_place(pointer<float> at) {
        Box box;
        box.low = load_svec(at);
        box.high = load_svec(at + 3);
        return box;
    }
    static void store_place(pointer<float> at, const Box& box) {
        store_svec(at, box.low);
        store_svec(at + 3, box.high);
    }
    Box moved(sint birth, const svec& anchor, const Box& one, const Box& other) const {
        Box box = place(anchor);
        if (branch(target < moving_from(birth)))
            return box;
        svec low = middle(one.low, other.low);
        svec high = middle(one.high, other.high);
        return hold(box, {low, high});
    }
};

/// Corners of one block after the other: what children of one block share is found once, if they come
/// together.
class Siblings {
public:
    explicit Siblings(sfloat target) : target_(target), seen_{target} {}

    /// As find_corners() for this target.
    pointer<float> corners_of(const Context& c, sint line) {
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        CornerReach own{target_};
        sbool alone = own.at_rest(block, birth_of_corners(block));
        sint parent_line = load(field(block, &BlockHeader::parent));
        if (branch(alone | (parent_line < 0)))
            return find_corners(c, own, line);
        pointer<BlockHeader> parent = as<BlockHeader>(c.grids + parent_line);
        pointer<float> shared = c.stack + scratch_siblings;
        if (branch(parent_line != parent_)) {
            parent_ = parent_line;
            seen_ = own;
            seen_.climb(parent);
            pointer<float> corners = find_corners(c, seen_, parent_line);
            for (int k = 0; k < 4; ++k) {
                Box box = seen_.load_place(corners + CornerReach::words * k);
                seen_.store_place(shared + CornerReach::words * k, box);
            }
        }
        sint patch = load(field(block, &BlockHeader::patch));
        sint root_line = load(field(c.open + patch, &OpenPatch::root));
        pointer<BlockHeader> root = as<BlockHeader>(c.grids + root_line);
        pointer<float> corners = c.stack + scratch_corners;
        move_corners(seen_, parent, block, shared, corners);
        move_middles(seen_, block, root, corners);
        return corners;
    }

private:
    sfloat target_;
    sint parent_ = -1; // of whom these are children ...
    CornerReach seen_; // ... and what its corners, and all above, are seen by
};

/// A box of block `line`, in its instance's coordinates, made to hold everything that its vertices can be
/// moved to where target edge lengths are at most that of `siblings`; in scene coordinates. Inside a block
/// vertices move towards others of it; so all depends on its corners.
inline Box reach_from(const Context& c, sint line, Box box, Siblings& siblings) {
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint instance = load(field(block, &BlockHeader::instance));
    sint corners_at = load(field(block, &BlockHeader::corners_at));
    sbool morphs = load(field(c.frame, &FrameHeader::morphs)) != 0;
    if (branch(morphs & (corners_at != no_vertex_moves))) {
        pointer<float> corners = siblings.corners_of(c, line);
        for (int k = 0; k < 4; ++k)
            box = hold(box, CornerReach::load_place(corners + CornerReach::words * k));
    }
    svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
    box.low = box.low + origin;
    box.high = box.high + origin;
    return box;
}

/// That of its box, which holds everything finer, too.
inline Box reach_of(const Context& c, sint line, Siblings& siblings) {
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    return reach_from(c, line, box_of(block), siblings);
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
