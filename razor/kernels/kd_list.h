// Item lists of unsplit kd nodes and leaves (layout.h): items with their boxes, as arrays.
#pragma once

#include "razor/kernels/reach.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

struct List {
    pointer<ItemList> header;
    pointer<std::int32_t> items;
    pointer<float> boxes; // low x[stride], y, z, high x, y, z
    sint line, count, stride, depth;
    svec low, high; // of the cell
};

/// Lists come in few sizes, so that those that are done with can be used again: multiples of 4 items, and
/// powers of two from 64 on. Most are short.
inline constexpr int short_list = 64;
inline sint list_stride(sint count) {
    sint stride = (count + 3) & -4;
    if (branch(count > short_list)) {
        sint exponent = (as_int(to_float(count - 1)) >> 23) - 126;
        stride = sint(1) << exponent;
    }
    return stride;
}
/// The number of its size.
inline sint list_size(sint stride) {
    sint size = stride >> 2;
    if (branch(stride > short_list)) {
        sint exponent = (as_int(to_float(stride)) >> 23) - 127;
        size = exponent + (short_list / 4 - 6); // log2(short_list) is 6
    }
    return size;
}

/// Gives a list back that nobody will read again: it was split, or opened or refined into another.
inline void free_list(const Context& c, sint line, sint stride) {
    pointer<std::int32_t> first = as<std::int32_t>(c.stack + scratch_free_lists) + list_size(stride);
    sint next = load(first);
    store(as<std::int32_t>(c.lists + line), next);
    store(first, line);
}

/// Room for `count` items; the header is written by close_list.
inline List make_list(const Context& c, sint count, sint depth, const svec& low, const svec& high) {
    List l;
    l.count = count;
    l.depth = depth;
    l.low = low;
    l.high = high;
    l.stride = list_stride(count);
    pointer<std::int32_t> first = as<std::int32_t>(c.stack + scratch_free_lists) + list_size(l.stride);
    l.line = load(first);
    if (branch(l.line >= 0)) {
        sint next = load(as<std::int32_t>(c.lists + l.line));
        store(first, next);
    } else {
        sint words = l.stride * 7 + 15;
        sint lines = (words >> 4) + item_list_words / 16;
        l.line = allocate(c, &WorkerRecord::list_next, &WorkerRecord::list_end, lines, trap_lists_full);
    }
    l.header = as<ItemList>(c.lists + l.line);
    pointer<float> arrays = as<float>(l.header) + item_list_words;
    l.items = as<std::int32_t>(arrays);
    l.boxes = arrays + l.stride;
    return l;
}

/// Traffic to the list counts under level - finer; or under the level of `other`.
struct ItemAndBox {
    std::int32_t item;
    float box[6];
};
inline void note_list_level(const List& l, sint level, int finer) {
    note_level(l.header, 1, level, finer);
    note_level(as<ItemAndBox>(l.items), l.stride, level, finer);
}
inline void note_list_level_of(const List& l, const List& other) {
    note_level_of(l.header, 1, other.header);
    note_level_of(as<ItemAndBox>(l.items), l.stride, other.header);
}

inline void close_list(const List& l) {
    store(field(l.header, &ItemList::count), l.count);
    store(field(l.header, &ItemList::stride), l.stride);
    store(field(l.header, &ItemList::depth), l.depth);
    store(field(l.header, &ItemList::finer), -1);
    pointer<float> low = field(l.header, &ItemList::cell_low);
    store(low, l.low.x);
    store(low + 1, l.low.y);
    store(low + 2, l.low.z);
    pointer<float> high = field(l.header, &ItemList::cell_high);
    store(high, l.high.x);
    store(high + 1, l.high.y);
    store(high + 2, l.high.z);
}

inline List read_list(const Context& c, sint line) {
    List l;
    l.line = line;
    l.header = as<ItemList>(c.lists + line);
    l.count = load(field(l.header, &ItemList::count));
    l.stride = load(field(l.header, &ItemList::stride));
    l.depth = load(field(l.header, &ItemList::depth));
    l.low = load_svec(field(l.header, &ItemList::cell_low));
    l.high = load_svec(field(l.header, &ItemList::cell_high));
    pointer<float> words = as<float>(l.header) + item_list_words;
    l.items = as<std::int32_t>(words);
    l.boxes = words + l.stride;
    return l;
}

/// A vector of items and boxes.
struct Items {
    vint item;
    vfloat box[6]; // low x, y, z, high x, y, z
};

inline Items load_items(const List& l, sint from, const vmask& m) {
    Items v;
    v.item = load_vector(l.items + from, m);
    pointer<float> box = l.boxes + from;
    for (int k = 0; k < 6; ++k) {
        v.box[k] = load_vector(box, m);
        box = box + l.stride;
    }
    return v;
}

/// Writes the lanes of v that m names from position `at` on; returns the position after them.
inline sint append(const List& l, sint at, const Items& v, const vmask& m) {
    sint n = count(m);
    if (branch(n == 0))
        return at;
    vmask written = first_lanes(n);
    vint item = compress(v.item, m);
    store_vector(l.items + at, item, written);
    pointer<float> box = l.boxes + at;
    for (int k = 0; k < 6; ++k) {
        store_vector(box, compress(v.box[k], m), written);
        box = box + l.stride;
    }
    return at + n;
}

/// Whether an item lies on the lower, and on the upper side of a plane; a flat item in the plane is on the
/// lower one.
inline vmask is_below(const vfloat& low, const vfloat& high, const vfloat& plane) {
    vmask begins = low < plane;
    return begins | (high <= plane);
}
inline vmask is_above(const vfloat& high, const vfloat& plane) {
    return high > plane;
}

/// Appends block `line`, with its box in scene coordinates, if that meets the list's cell; returns the
/// position after it.
inline sint append_block(const List& l, sint at, sint line, const svec& low, const svec& high) {
    sbool meets = low.x <= l.high.x;
    meets = meets & (high.x >= l.low.x);
    meets = meets & (low.y <= l.high.y);
    meets = meets & (high.y >= l.low.y);
    meets = meets & (low.z <= l.high.z);
    meets = meets & (high.z >= l.low.z);
    if (branch(!meets))
        return at;
    sint item = sint(-1) - line;
    store(l.items + at, item);
    pointer<float> box = l.boxes + at;
    store(box, low.x);
    store(box + l.stride, low.y);
    store(box + l.stride * 2, low.z);
    store(box + l.stride * 3, high.x);
    store(box + l.stride * 4, high.y);
    store(box + l.stride * 5, high.z);
    return at + 1;
}

/// What rays can want of a leaf's blocks.
struct Leaf {
    sint level;     // absolute, of those that have children; least_level: none has
    svec low, high; // of everything finer, and of everything that can move
};
inline constexpr int least_level = -200;

/// Widens the leaf's box by that of everything at or below a block.
inline void widen(const Context& c, pointer<BlockHeader> block, Leaf& leaf) {
    sint instance = load(field(block, &BlockHeader::instance));
    svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
    svec low = load_svec(field(block, &BlockHeader::box_low));
    svec high = load_svec(field(block, &BlockHeader::box_high));
    low = low + origin;
    high = high + origin;
    leaf.low = {min(low.x, leaf.low.x), min(low.y, leaf.low.y), min(low.z, leaf.low.z)};
    leaf.high = {max(high.x, leaf.high.x), max(high.y, leaf.high.y), max(high.z, leaf.high.z)};
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
    List l = make_list(c, total, old.depth, old.low, old.high); // the same cell: no deeper in the tree
    note_list_level(l, level, 1);
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
                Reach box = reach_of(c, child, most);
                at = append_block(l, at, child, box.low, box.high);
                child = child + step;
            }
        } else {
            Reach box;
            box.low.x = load(old.boxes + i);
            box.low.y = load(old.boxes + old.stride + i);
            box.low.z = load(old.boxes + old.stride * 2 + i);
            box.high.x = load(old.boxes + old.stride * 3 + i);
            box.high.y = load(old.boxes + old.stride * 4 + i);
            box.high.z = load(old.boxes + old.stride * 5 + i);
            at = append_block(l, at, line, box.low, box.high);
        }
    }
    l.count = at;
    return l;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
