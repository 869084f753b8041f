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
inline Reach box_in_scene(const Context& c, pointer<BlockHeader> block) {
    sint instance = load(field(block, &BlockHeader::instance));
    svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
    svec low = load_svec(field(block, &BlockHeader::box_low));
    svec high = load_svec(field(block, &BlockHeader::box_high));
    return {low + origin, high + origin};
}

/// Widens the leaf's box by that.
inline void widen(const Context& c, pointer<BlockHeader> block, Leaf& leaf) {
    Reach all = hold({leaf.low, leaf.high}, box_in_scene(c, block));
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
        sint movable = load(field(block, &BlockHeader::movable));
        sint absolute = load(field(block, &BlockHeader::absolute));
        absolute = max(absolute, leaf.level);
        leaf.level = select(level > 0, absolute, leaf.level);
        if (branch((level | movable) != 0)) {
            widen(c, block, leaf);
            sint hangs = load(field(block, &BlockHeader::hangs));
            if (branch(hangs != 0))
                widen_along_edges(c, block, leaf);
        }
    }
    return leaf;
}

/// The box of a block's vertices as they lie.
inline Reach vertices_of(pointer<BlockHeader> block) {
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint several = load(field(block, &BlockHeader::cells_at));
    sint stride = load(field(block, &BlockHeader::stride));
    sint shift = cells_shift(quads_u);
    sint cells = ((quads_v + 1) >> 1) << shift;
    // Of cells, or of the vertices of a block that is one.
    sint n = select(several != 0, cells, stride);
    sint step = select(several != 0, sint(cell_boxes), stride);
    sint lows_at = select(several != 0, several, sint(block_header_words));
    pointer<float> lows = as<float>(block) + lows_at;
    sint highs_at = step * 3;
    highs_at = select(several != 0, highs_at, sint(0));
    pointer<float> highs = lows + highs_at;
    sfloat low[3], high[3];
    vfloat big(3.0e38F);
    for (int k = 0; k < 3; ++k) {
        vfloat least = big;
        vfloat most = -big;
        for (sint from = 0; branch(from < n); from += isa::width) {
            vmask m = first_lanes(n - from);
            vfloat a = load_vector(lows + from, m);
            least = min(select(m, a, big), least);
            vfloat b = load_vector(highs + from, m);
            most = max(select(m, b, -big), most);
        }
        low[k] = reduce_min(least);
        high[k] = reduce_max(most);
        lows = lows + step;
        highs = highs + step;
    }
    Reach box;
    box.low = {low[0], low[1], low[2]};
    box.high = {high[0], high[1], high[2]};
    return box;
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
        Reach box = load_box(l, i);
        if (branch(deviation > largest(box.high - box.low) * worth_tightening))
            box = reach_from(c, line, vertices_of(block), siblings);
        sint at = i;
        if (branch(meets_cell(l, box))) {
            if (branch(in_cell != i)) {
                sint other = load(l.items + in_cell);
                Reach others = load_box(l, in_cell);
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
            sint columns = load(field(block, &BlockHeader::child_columns));
            sint rows = load(field(block, &BlockHeader::child_rows));
            total = total + columns * rows;
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
            sint step = load(field(block, &BlockHeader::child_lines));
            sint columns = load(field(block, &BlockHeader::child_columns));
            sint rows = load(field(block, &BlockHeader::child_rows));
            sint children = columns * rows;
            for (sint k = 0; branch(k < children); ++k) {
                Reach box = reach_of(c, child, siblings);
                at = append_block(l, at, child, box);
                child = child + step;
            }
        } else {
            // Where the leaf's rays meet it, and where it is finer.
            Reach box = load_box(old, i);
            Reach all = box_in_scene(c, block);
            box = hold(box, all);
            at = append_block(l, at, line, box);
        }
    }
    l.count = at;
    return l;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
