// Item lists of unsplit kd nodes and leaves (layout.h): items with their boxes, as arrays.
#pragma once

#include "razor/kernels/budget_room.h"
#include "razor/kernels/dead.h"
#include "razor/kernels/reach.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

struct List {
    pointer<ItemList> header;
    pointer<std::int32_t> items;
    pointer<float> boxes; // low x[stride], y, z, high x, y, z
    sint line, count, stride, depth;
    sfloat most;    // target edge length, of rays that come here
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

inline sint list_lines(sint stride) {
    sint words = stride * 7 + 15;
    return (words >> 4) + item_list_words / 16;
}

/// Gives a list back that nobody will read again: it was split, or opened or refined into another.
inline void free_list(const Context& c, sint line, sint stride) {
    pointer<std::int32_t> first = as<std::int32_t>(c.stack + scratch_free_lists) + list_size(stride);
    sint next = load(first);
    store(as<std::int32_t>(c.lists + line), next);
    store(first, line);
    if (branch(c.discards)) {
        sint others = list_lines(stride) - 1;
        sint first_other = line + 1;
        pointer<Line> second = c.lists + first_other;
        discard_lines(second, others);
    }
}

/// Room for `count` items, for rays with target edge lengths up to `most`; the header is written by
/// close_list.
inline List make_list(const Context& c, sint count, sint depth, sfloat most, const svec& low,
                      const svec& high) {
    List l;
    l.count = count;
    l.depth = depth;
    l.most = most;
    l.low = low;
    l.high = high;
    l.stride = list_stride(count);
    pointer<std::int32_t> first = as<std::int32_t>(c.stack + scratch_free_lists) + list_size(l.stride);
    l.line = load(first);
    if (branch(l.line >= 0)) {
        sint next = load(as<std::int32_t>(c.lists + l.line));
        store(first, next);
    } else {
        l.line = allocate(c, &WorkerRecord::list_next, &WorkerRecord::list_end, list_lines(l.stride),
                          trap_lists_full);
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
    store(field(l.header, &ItemList::most), l.most);
    store(field(l.header, &ItemList::in_cell), 0);
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
    l.most = load(field(l.header, &ItemList::most));
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

/// Item i's box.
inline Box load_box(const List& l, sint i) {
    pointer<float> at = l.boxes + i;
    Box box;
    box.low.x = load(at);
    box.low.y = load(at + l.stride);
    box.low.z = load(at + l.stride * 2);
    box.high.x = load(at + l.stride * 3);
    box.high.y = load(at + l.stride * 4);
    box.high.z = load(at + l.stride * 5);
    return box;
}
inline void store_item(const List& l, sint i, sint item, const Box& box) {
    store(l.items + i, item);
    pointer<float> at = l.boxes + i;
    store(at, box.low.x);
    store(at + l.stride, box.low.y);
    store(at + l.stride * 2, box.low.z);
    store(at + l.stride * 3, box.high.x);
    store(at + l.stride * 4, box.high.y);
    store(at + l.stride * 5, box.high.z);
}

inline sbool meets_cell(const List& l, const Box& box) {
    sbool meets = box.low.x <= l.high.x;
    meets = meets & (box.high.x >= l.low.x);
    meets = meets & (box.low.y <= l.high.y);
    meets = meets & (box.high.y >= l.low.y);
    meets = meets & (box.low.z <= l.high.z);
    return meets & (box.high.z >= l.low.z);
}

/// Appends block `line`, with its box in scene coordinates, if that meets the list's cell; returns the
/// position after it.
inline sint append_block(const List& l, sint at, sint line, const Box& box) {
    if (branch(!meets_cell(l, box)))
        return at;
    store_item(l, at, sint(-1) - line, box);
    return at + 1;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
