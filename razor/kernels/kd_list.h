// Item lists of unsplit kd nodes and leaves: patches (number >= 0) and blocks (~first line) with their boxes,
// as arrays.
#pragma once

#include "razor/kernels/tessellate.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

struct List {
    pointer<ItemList> header;
    pointer<std::int32_t> items;
    pointer<float> boxes; // low x[stride], y, z, high x, y, z
    sint line, count, stride, depth;
    svec low, high; // of the cell
};

inline sint list_stride(sint count) {
    return (count + 15) & -16;
}

/// Room for `count` items; the header is written by close_list.
inline List make_list(const Context& c, sint count, sint depth, const svec& low, const svec& high) {
    List l;
    l.count = count;
    l.depth = depth;
    l.low = low;
    l.high = high;
    l.stride = list_stride(count);
    sint lines = (l.stride * 7 >> 4) + 1;
    l.line = allocate(c, &WorkerRecord::list_next, &WorkerRecord::list_end, lines, trap_lists_full);
    l.header = as<ItemList>(c.lists + l.line);
    pointer<float> words = as<float>(l.header) + item_list_words;
    l.items = as<std::int32_t>(words);
    l.boxes = words + l.stride;
    return l;
}

inline void close_list(const List& l) {
    store(field(l.header, &ItemList::count), l.count);
    store(field(l.header, &ItemList::stride), l.stride);
    store(field(l.header, &ItemList::depth), l.depth);
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

/// Opens the patches among the items that `wanted` chooses and returns the list with their blocks instead.
template <class Wanted> inline List open_items(const Context& c, const List& old, Wanted wanted) {
    sint total = old.count;
    for (sint from = 0; branch(from < old.count); from += isa::width) {
        vmask valid = first_lanes(old.count - from);
        Items v = load_items(old, from, valid);
        vmask m = valid & wanted(v);
        for (; branch(any(m)); m = clear_first(m)) {
            sint patch = extract(v.item, first(m));
            pointer<OpenPatch> entry = open_patch(c, patch);
            sint blocks = load(field(entry, &OpenPatch::blocks));
            total = total + (blocks - 1);
        }
    }
    List l = make_list(c, total, old.depth, old.low, old.high);
    sint at = 0;
    for (sint from = 0; branch(from < old.count); from += isa::width) {
        vmask valid = first_lanes(old.count - from);
        Items v = load_items(old, from, valid);
        vmask m = valid & wanted(v);
        at = append(l, at, v, valid & !m);
        for (; branch(any(m)); m = clear_first(m)) {
            sint patch = extract(v.item, first(m));
            pointer<OpenPatch> entry = c.open + patch;
            sint line = load(field(entry, &OpenPatch::first_line));
            sint blocks = load(field(entry, &OpenPatch::blocks));
            sint step = load(field(entry, &OpenPatch::block_lines));
            sint mesh = load(field(c.patches + patch, &PatchRecord::mesh));
            svec origin = load_svec(field(c.meshes + mesh, &MeshRecord::origin));
            for (sint i = 0; branch(i < blocks); ++i) {
                pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
                svec low = load_svec(field(block, &BlockHeader::box_low));
                svec high = load_svec(field(block, &BlockHeader::box_high));
                low = low + origin;
                high = high + origin;
                sbool meets = low.x <= old.high.x;
                meets = meets & (high.x >= old.low.x);
                meets = meets & (low.y <= old.high.y);
                meets = meets & (high.y >= old.low.y);
                meets = meets & (low.z <= old.high.z);
                meets = meets & (high.z >= old.low.z);
                if (branch(meets)) {
                    sint item = sint(-1) - line;
                    store(l.items + at, item);
                    pointer<float> box = l.boxes + at;
                    store(box, low.x);
                    store(box + l.stride, low.y);
                    store(box + l.stride * 2, low.z);
                    store(box + l.stride * 3, high.x);
                    store(box + l.stride * 4, high.y);
                    store(box + l.stride * 5, high.z);
                    ++at;
                }
                line = line + step;
            }
        }
    }
    l.count = at;
    return l;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
