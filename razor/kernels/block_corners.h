// The corners of a block: where they are if they have not moved, and how far they can. Finer blocks have them
// before they have vertices, from their parent.
#pragma once

#include "razor/kernels/block_shape.h"
#include "razor/kernels/box.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

inline svec load_vertex(pointer<float> vertices, sint stride, sint i) {
    svec p;
    p.x = load(vertices + i);
    p.y = load(vertices + stride + i);
    p.z = load(vertices + stride * 2 + i);
    return p;
}

/// Of the block, and of the ends of ancestors that are longer: see bound_ancestors().
inline pointer<float> box_with_ancestors(pointer<BlockHeader> block) {
    pointer<float> box = field(block, &BlockHeader::box_low);
    sint ancestors_at = load(field(block, &BlockHeader::ancestors_at));
    if (branch(ancestors_at != 0))
        box = as<float>(block) + (ancestors_at + ancestor_box);
    return box;
}

/// Number of the vertex at corner k.
inline sint corner_vertex(int k, sint quads_u, sint quads_v) {
    sint last_row = (quads_u + 1) * quads_v;
    if (k == 0)
        return 0;
    if (k == 1)
        return quads_u;
    return k == 2 ? last_row + quads_u : last_row;
}

/// Where corner k of a block is if it has not moved. On a side that hangs from an edge longer than the block
/// that is not where the block has it, but where its curve has it at level 0.
inline svec corner_anchor(pointer<BlockHeader> block, int k) {
    sint corners_at = load(field(block, &BlockHeader::corners_at));
    if (branch(corners_at > corners_lie_in_vertices)) {
        sint at = corners_at + 3 * k;
        return load_svec(as<float>(block) + at);
    }
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    pointer<float> vertices = as<float>(block) + block_header_words;
    return load_vertex(vertices, stride, corner_vertex(k, quads_u, quads_v));
}

/// The corner at (i, j), each 0 or 1.
inline svec corner_anchor_at(pointer<BlockHeader> block, sint i, sint j) {
    svec low = corner_anchor(block, 0);
    if (branch(i > j))
        low = corner_anchor(block, 1);
    if (branch(j > i))
        low = corner_anchor(block, 3);
    if (branch((i & j) != 0))
        low = corner_anchor(block, 2);
    return low;
}

inline sfloat largest_component_of(const svec& p) {
    sfloat y = abs(p.y);
    sfloat z = abs(p.z);
    z = max(y, z);
    return max(abs(p.x), z);
}

/// One end of side s of a block, from the curve as it is at level 0, where it may hang as well: from longer
/// edges of coarser levels it would hang elsewhere. The means are those of place_side(), bit for bit.
inline void place_corner(const Context& c, const Cage& finest, const Dicing& d, int s, sint along,
                         pointer<float> out) {
    const Side& side = d.side[s];
    sint flat = (s % 2 == 0 ? d.nu : d.nv) + half(side);
    sint finer = side.whole - flat;
    sint up = max(finer, 0);
    sint down = max(-finer, 0);
    sint index = (along << up) >> down;
    sint rest = along & ((sint(1) << down) - 1);
    sint chunks = sint(1) << max(side.whole - block_log2, 0);
    sint last = chunks - 1;
    sint chunk = min(index >> block_log2, last);
    pointer<float> points = curve_points<false>(c, finest, finest.curves + side.curve, side.whole, chunk);
    sint from = index - chunk * block_quads;
    svec p = get_point(points, from);
    if (branch(rest != 0)) {
        svec end = get_point(points, from + 1);
        for (sint h = down - 1; branch(h >= 0); --h) {
            svec mean = middle(p, end);
            if (branch(((rest >> h) & 1) != 0))
                p = mean;
            else
                end = mean;
        }
    }
    store_svec(out, p);
}

/// The corners of a block on sides that hang from edges longer than `longest` of the side's segments, from
/// the sides' curves.
template <class Longest>
inline void place_hanging_corners(const Context& c, Cage g, const Dicing& d, const Block& b,
                                  Longest longest) {
    pointer<float> out = b.words + b.corners_at;
    g.level = 0;
    constexpr int ends[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
    for (int s = 0; s < 4; ++s) {
        const Side& side = d.side[s];
        sint quads = s % 2 == 0 ? b.quads_u : b.quads_v;
        sint hang = load(field(b.header, &BlockHeader::hang) + s); // 0 if the side is inside the patch
        sint limit = longest(quads);
        if (branch((sint(1) << hang) > limit)) {
            sint total = sint(1) << ((s % 2 == 0 ? d.nu : d.nv) + half(side));
            sint begin = (s % 2 == 0 ? b.column : b.row) * block_quads;
            for (int e = 0; e < 2; ++e) {
                sint along = begin + (e == 0 ? sint(0) : quads);
                sbool reversed = (side.flags & side_reversed) != 0;
                along = select(reversed, total - along, along);
                place_corner(c, g, d, s, along, out + 3 * ends[s][e]);
            }
        }
    }
}

/// The corners of a block that keeps them: see corner_anchor.
template <bool Straight>
inline void place_corners(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    pointer<float> out = b.words + b.corners_at;
    for (int k = 0; k < 4; ++k) {
        svec p = load_vertex(b.x, b.stride, corner_vertex(k, b.quads_u, b.quads_v));
        store_svec(out + 3 * k, p);
    }
    if constexpr (!Straight) {
        if (branch(b.ancestors_at != 0))
            place_hanging_corners(c, g, d, b, [](sint quads) { return quads; });
    }
}

/// The corners of a block that is this part of its parent: vertices of the parent, bit for bit, but where
/// these hang.
inline void take_corners(pointer<BlockHeader> parent, const Part& part, const Block& b) {
    sint quads_u = load(field(parent, &BlockHeader::quads_u));
    sint quads_v = load(field(parent, &BlockHeader::quads_v));
    sint stride = load(field(parent, &BlockHeader::stride));
    pointer<float> vertices = as<float>(parent) + block_header_words;
    pointer<float> out = b.words + b.corners_at;
    sint middle_u = quads_u >> 1;
    sint middle_v = quads_v >> 1;
    sint first_u = select(part.u > 0, middle_u, sint(0));
    sint first_v = select(part.v > 0, middle_v, sint(0));
    sint last_u = select(part.u == 0, middle_u, quads_u);
    sint last_v = select(part.v == 0, middle_v, quads_v);
    sint width = quads_u + 1;
    for (int k = 0; k < 4; ++k) {
        sint column = k == 1 || k == 2 ? last_u : first_u;
        sint row = k >= 2 ? last_v : first_v;
        store_svec(out + 3 * k, load_vertex(vertices, stride, row * width + column));
    }
}

/// How far a block's corners are from where they lie in it.
inline sfloat corners_lie(const Block& b) {
    sfloat lie = 0.0F;
    for (int k = 0; k < 4; ++k) {
        svec own = corner_anchor(b.header, k);
        svec there = load_vertex(b.x, b.stride, corner_vertex(k, b.quads_u, b.quads_v));
        lie = max(lie, largest_component_of(own - there));
    }
    return lie;
}

/// Whether a block or its parent has ancestors.
inline sbool has_ancestors(const Context& c, const Block& b, sint parent) {
    sint above = 0;
    if (branch(parent >= 0))
        above = load(field(as<BlockHeader>(c.grids + parent), &BlockHeader::ancestors_at));
    return (b.ancestors_at | above) != 0;
}

/// Of a limit surface where that is so: how far a block's corners are from the means of corners of its
/// parent: see BlockHeader::corner_sway.
inline sfloat corners_off(const Context& c, const Dicing& d, const Block& b, sint parent) {
    sfloat off = 0.0F;
    pointer<BlockHeader> above = b.header;
    if (branch(parent >= 0))
        above = as<BlockHeader>(c.grids + parent);
    sbool split_u = d.nu > block_log2;
    sbool split_v = d.nv > block_log2;
    for (int k = 0; k < 4; ++k) {
        int right = k == 1 || k == 2 ? 1 : 0;
        int up = k >= 2 ? 1 : 0;
        svec own = corner_anchor(b.header, k);
        if (branch(parent >= 0)) {
            // In halves of the parent.
            sint i = select(split_u, (b.column & 1) + right, sint(2 * right));
            sint j = select(split_v, (b.row & 1) + up, sint(2 * up));
            sint odd_i = i & 1;
            sint odd_j = j & 1;
            sint low_i = (i - odd_i) >> 1;
            sint low_j = (j - odd_j) >> 1;
            svec one = corner_anchor_at(above, low_i, low_j);
            sint high_i = low_i + odd_i;
            sint high_j = low_j + odd_j;
            svec other = corner_anchor_at(above, high_i, high_j);
            off = max(off, largest_component_of(own - middle(one, other)));
        }
    }
    return off;
}

/// Where the ends of a sub-face's two half edges are beyond it.
template <bool Straight>
inline void place_middles(const Context& c, const Cage& g, const Dicing& d, pointer<float> out) {
    for (int k = 0; k < 2; ++k) {
        const Side& side = d.side[k == 0 ? 0 : 3];
        pointer<CurveRecord> curve = g.curves + side.curve;
        sint end0 = load(field(curve, &CurveRecord::end0));
        sint end1 = load(field(curve, &CurveRecord::end1));
        svec a = vertex_position<Straight>(c, g, end0);
        svec z = vertex_position<Straight>(c, g, end1);
        svec mean = middle(a, z);
        // The half next to the side's start is ours; a reversed side starts at the curve's end.
        sint own_end = load(field(d.record, &PatchRecord::corner));
        sbool far_is_first = own_end != end0;
        svec far;
        far.x = select(far_is_first, a.x, z.x);
        far.y = select(far_is_first, a.y, z.y);
        far.z = select(far_is_first, a.z, z.z);
        pointer<float> to = out + (ends_mean + 3 * k);
        store(to, mean.x);
        store(to + 1, mean.y);
        store(to + 2, mean.z);
        to = out + (ends_far + 3 * k);
        store(to, far.x);
        store(to + 1, far.y);
        store(to + 2, far.z);
    }
}

/// How far corners that are middles of edges are from the means of the edges' ends; place(k): where the block
/// has corner k.
template <class Place>
inline sfloat middle_sway(const Context& c, const Dicing& d, const Shape& s, const Block& b, sint parent,
                          Place place) {
    sfloat most = 0.0F;
    pointer<BlockHeader> root = b.header;
    if (branch(parent >= 0)) {
        sint line = load(field(c.open + d.patch, &OpenPatch::root));
        root = as<BlockHeader>(c.grids + line);
    }
    sint at = load(field(root, &BlockHeader::middles));
    sbool there[2] = {b.column == s.columns - 1, b.column == 0};
    there[0] = there[0] & (b.row == 0);
    there[1] = there[1] & (b.row == s.rows - 1);
    for (int k = 0; k < 2; ++k) {
        if (branch(there[k])) {
            svec mean = load_svec(as<float>(root) + at + (ends_mean + 3 * k));
            most = max(largest_component_of(place(k == 0 ? 1 : 3) - mean), most);
        }
    }
    return most;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
