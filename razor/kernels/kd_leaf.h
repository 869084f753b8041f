// Leaves of the kd-tree: lists of blocks of one level, and what is finer in the same cell.
#pragma once

#include "razor/kernels/kd_list.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// What rays can want of a leaf's blocks.
struct Leaf {
    sint level;     // absolute, of those that have children; least_level: none has
    svec low, high; // of everything finer, and of everything that can move
};
inline constexpr int least_level = -200;

/// The box of everything at or below a block, scene coordinates.
inline Box box_in_scene(const Context& c, pointer<BlockHeader> block) {
    sint instance = load(field(block, &BlockHeader::instance));
    svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
    Box box = box_of(block);
    return {box.low + origin, box.high + origin};
}

/// Widens the leaf's box by that.
inline void widen(const Context& c, pointer<BlockHeader> block, Leaf& leaf) {
    Box all = hold({leaf.low, leaf.high}, box_in_scene(c, block));
    leaf.low = all.low;
    leaf.high = all.high;
}

/// A side that hangs from an edge longer than the block is where that edge's vertices say, which lie outside
/// the block, if one of them has not gone. So they count too: with the first coarser block that spans the
/// edge.
inline void widen_along_edges(const Context& c, pointer<BlockHeader> block, Leaf& leaf) {
    sint longest = 0; // by how much an edge is longer, log2
    for (int s = 0; s < 4; ++s) {
        sint hang = load(field(block, &BlockHeader::hang) + s);
        sint curve = load(field(block, &BlockHeader::curve) + s);
        sint quads = load(field(block, s % 2 == 0 ? &BlockHeader::quads_u : &BlockHeader::quads_v));
        sint more = hang - log2_quads(quads);
        more = max(more, longest);
        longest = select(curve >= 0, more, longest);
    }
    if (branch(longest <= 0))
        return;
    sint parent = load(field(block, &BlockHeader::parent));
    while (branch(longest > 0)) {
        if (branch(parent < 0))
            break;
        block = as<BlockHeader>(c.grids + parent);
        parent = load(field(block, &BlockHeader::parent));
        --longest;
    }
    widen(c, block, leaf);
}

/// One block after the other: leaves are short.
inline Leaf survey(const Context& c, const List& l) {
    Leaf leaf;
    leaf.level = least_level;
    leaf.low = {sfloat(3.0e38F), sfloat(3.0e38F), sfloat(3.0e38F)};
    leaf.high = {sfloat(-3.0e38F), sfloat(-3.0e38F), sfloat(-3.0e38F)};
    for (sint i = 0; branch(i < l.count); ++i) {
        sint item = load(l.items + i);
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + (sint(-1) - item));
        sint level = load(field(block, &BlockHeader::level));
        sint corners_at = load(field(block, &BlockHeader::corners_at));
        sint absolute = load(field(block, &BlockHeader::absolute));
        absolute = max(absolute, leaf.level);
        leaf.level = select(level > 0, absolute, leaf.level);
        sbool moves = corners_at != no_vertex_moves;
        if (branch(moves | (level > 0))) {
            widen(c, block, leaf);
            sint hangs = load(field(block, &BlockHeader::hangs));
            if (branch(hangs != 0))
                widen_along_edges(c, block, leaf);
        }
    }
    return leaf;
}

/// Boxes that finer vertices make wider by less of their largest side are left as they are.
inline constexpr float worth_tightening = 1.0F / 16;

/// A leaf's list as rays meet it: boxes of the blocks alone, without what is finer, and first those that are
/// in the cell.
inline void tighten(const Context& c, const List& l) {
    Siblings siblings(l.most);
    sint in_cell = 0;
    for (sint i = 0; branch(i < l.count); ++i) {
        sint item = load(l.items + i);
        sint line = sint(-1) - item;
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sfloat deviation = load(field(block, &BlockHeader::deviation));
        Box box = load_box(l, i);
        if (branch(deviation > largest(box.high - box.low) * worth_tightening))
            box = reach_from(c, line, vertices_of(block), siblings);
        sint at = i;
        if (branch(meets_cell(l, box))) {
            if (branch(in_cell != i)) {
                sint other = load(l.items + in_cell);
                Box others = load_box(l, in_cell);
                store_item(l, i, other, others);
            }
            at = in_cell;
            ++in_cell;
        }
        store_item(l, at, item, box);
    }
    store(field(l.header, &ItemList::in_cell), in_cell);
}

/// The items of a leaf one level finer: the children, as far as they meet the cell, of the blocks of the
/// leaf's level; the others stay.
inline List refine_items(const Context& c, const List& old) {
    sint level = load(field(old.header, &ItemList::level));
    sint total = 0;
    for (sint i = 0; branch(i < old.count); ++i) {
        sint line = sint(-1) - load(old.items + i);
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint absolute = load(field(block, &BlockHeader::absolute));
        sint finer = load(field(block, &BlockHeader::level));
        sbool refine = absolute == level;
        refine = refine & (finer > 0);
        if (branch(refine)) {
            ensure_children(c, line, block);
            sint shape = load(field(block, &BlockHeader::child_shape));
            total = total + children_in(shape);
        } else {
            ++total;
        }
    }
    sfloat most = load(field(old.header, &ItemList::coarsest));
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    most = select(fixed > 0.0F, fixed, most);
    List l = make_list(c, total, old.depth, most, old.low, old.high); // the same cell: no deeper in the tree
    note_list_level(l, level, 1);
    Siblings siblings(most);
    sint at = 0;
    for (sint i = 0; branch(i < old.count); ++i) {
        sint line = sint(-1) - load(old.items + i);
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint absolute = load(field(block, &BlockHeader::absolute));
        sint finer = load(field(block, &BlockHeader::level));
        sbool refine = absolute == level;
        refine = refine & (finer > 0);
        if (branch(refine)) {
            sint child = load(field(block, &BlockHeader::child_line));
            sint shape = load(field(block, &BlockHeader::child_shape));
            sint step = lines_between(shape);
            sint children = children_in(shape);
            for (sint k = 0; branch(k < children); ++k) {
                Box box = reach_of(c, child, siblings);
                at = append_block(l, at, child, box);
                child = child + step;
            }
        } else {
            // Where the leaf's rays meet it, and where it is finer.
            Box box = load_box(old, i);
            Box all = box_in_scene(c, block);
            box = hold(box, all);
            at = append_block(l, at, line, box);
        }
    }
    l.count = at;
    return l;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
