// What a block says of where its vertices and all finer ones can be: corners, boxes of cells, how far finer
// levels leave its triangles, and how far its vertices can leave their anchors.
#pragma once

#include "razor/kernels/dicing.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

inline svec load_vertex(pointer<float> vertices, sint stride, sint i) {
    svec p;
    p.x = load(vertices + i);
    p.y = load(vertices + stride + i);
    p.z = load(vertices + stride * 2 + i);
    return p;
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
/// that is not where the block has it, but where its curve has it at the level that it is born at.
inline svec corner_anchor(pointer<BlockHeader> block, int k) {
    sint ancestors_at = load(field(block, &BlockHeader::ancestors_at));
    if (branch(ancestors_at != 0))
        return load_svec(as<float>(block) + ancestors_at + (ancestor_words + 3 * k));
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

/// One end of side s of a block, from the curve as it is at level 0, if it is born at all.
inline void place_corner(const Context& c, const Cage& finest, const Dicing& d, int s, sint along,
                         pointer<float> out) {
    const Side& side = d.side[s];
    sint flat = (s % 2 == 0 ? d.nu : d.nv) + half(side);
    sint finer = side.whole - flat;
    sint up = max(finer, 0);
    sint down = max(-finer, 0);
    sint index = (along << up) >> down;
    sint rest = along & ((sint(1) << down) - 1);
    if (branch(rest != 0))
        return; // hangs at every level
    sint chunks = sint(1) << max(side.whole - block_log2, 0);
    sint last = chunks - 1;
    sint chunk = min(index >> block_log2, last);
    pointer<float> points = curve_points<false>(c, finest, finest.curves + side.curve, side.whole, chunk);
    svec p = get_point(points, index - chunk * block_quads);
    store_svec(out, p);
}

/// The corners of a block that has ancestors: see corner_anchor.
template <bool Straight>
inline void place_corners(const Context& c, Cage g, const Dicing& d, const Block& b) {
    pointer<float> out = b.words + b.ancestors_at + ancestor_words;
    for (int k = 0; k < 4; ++k) {
        svec p = load_vertex(b.x, b.stride, corner_vertex(k, b.quads_u, b.quads_v));
        store_svec(out + 3 * k, p);
    }
    if constexpr (!Straight) {
        g.level = 0;
        constexpr int ends[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
        sint last_column = (sint(1) << max(d.nu - block_log2, 0)) - 1;
        sint last_row = (sint(1) << max(d.nv - block_log2, 0)) - 1;
        sbool border[4] = {b.row == 0, b.column == last_column, b.row == last_row, b.column == 0};
        for (int s = 0; s < 4; ++s) {
            const Side& side = d.side[s];
            sint quads = s % 2 == 0 ? b.quads_u : b.quads_v;
            if (branch(border[s] & ((sint(1) << side.hang) > quads))) {
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
}

/// Of a limit surface: what ancestors add to how far a block's corners are from where they lie in it, and
/// from the means of corners of its parent: see BlockHeader::corner_sway.
inline sfloat measure_corners(const Context& c, const Dicing& d, const Block& b, sint parent) {
    sfloat lie = 0.0F;
    sfloat off = 0.0F;
    pointer<BlockHeader> above = b.header;
    if (branch(parent >= 0))
        above = as<BlockHeader>(c.grids + parent);
    sint ancestors = load(field(b.header, &BlockHeader::ancestors_at));
    sint ancestors_above = load(field(above, &BlockHeader::ancestors_at));
    if (branch((ancestors | ancestors_above) == 0))
        return 0.0F;
    sbool split_u = d.nu > block_log2;
    sbool split_v = d.nv > block_log2;
    for (int k = 0; k < 4; ++k) {
        int right = k == 1 || k == 2 ? 1 : 0;
        int up = k >= 2 ? 1 : 0;
        svec own = corner_anchor(b.header, k);
        svec there = load_vertex(b.x, b.stride, corner_vertex(k, b.quads_u, b.quads_v));
        lie = max(lie, largest_component_of(own - there));
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
    return lie + off;
}

/// The box of each of some vertices' cells, one lane a cell from number `from` on; shift: log2 of the cells a
/// row.
inline void bound_cells(pointer<float> x, sint stride, sint quads_u, sint quads_v, sint shift, sint from,
                        const vmask& m, vvec& lo, vvec& hi) {
    vint cell = lane_index() + vint(from);
    vint row = cell >> vint(shift);
    vint column = cell - (row << vint(shift));
    sint width = quads_u + 1;
    lo = {vfloat(3.0e38F), vfloat(3.0e38F), vfloat(3.0e38F)};
    hi = {vfloat(-3.0e38F), vfloat(-3.0e38F), vfloat(-3.0e38F)};
    for (int j = 0; j < 3; ++j) {
        vint vertex_row = (row << 1) + vint(j);
        vertex_row = min(vertex_row, vint(quads_v));
        vint row_begin = vertex_row * vint(width);
        for (int i = 0; i < 3; ++i) {
            vint vertex_column = (column << 1) + vint(i);
            vertex_column = min(vertex_column, vint(quads_u));
            vint at = row_begin + vertex_column;
            vfloat px = gather(x, at, m);
            vfloat py = gather(x + stride, at, m);
            vfloat pz = gather(x + stride * 2, at, m);
            lo = {min(px, lo.x), min(py, lo.y), min(pz, lo.z)};
            hi = {max(px, hi.x), max(py, hi.y), max(pz, hi.z)};
        }
    }
}

/// As they lie in a block.
inline void store_cells(pointer<float> out, const vvec& lo, const vvec& hi, const vmask& m) {
    store_vector(out, lo.x, m);
    store_vector(out + cell_boxes, lo.y, m);
    store_vector(out + 2 * cell_boxes, lo.z, m);
    store_vector(out + 3 * cell_boxes, hi.x, m);
    store_vector(out + 4 * cell_boxes, hi.y, m);
    store_vector(out + 5 * cell_boxes, hi.z, m);
}

/// log2 of the cells along u: of 1, 2 or 4.
inline sint cells_shift(sint quads_u) {
    sint cells_u = (quads_u + 1) >> 1;
    sbool wide = cells_u > 2;
    return select(wide, sint(2), cells_u - 1);
}

/// Boxes of the block's cells (stored if there are several); the block's own is made to hold them. One lane a
/// cell.
inline void bound_block(const Block& b, sint cells_at) {
    sint shift = cells_shift(b.quads_u);
    sint cells = ((b.quads_v + 1) >> 1) << shift;
    svec low{sfloat(3.0e38F), sfloat(3.0e38F), sfloat(3.0e38F)};
    svec high{sfloat(-3.0e38F), sfloat(-3.0e38F), sfloat(-3.0e38F)};
    for (sint from = 0; branch(from < cells); from += isa::width) {
        vmask m = first_lanes(cells - from);
        vvec lo, hi;
        bound_cells(b.x, b.stride, b.quads_u, b.quads_v, shift, from, m, lo, hi);
        if (branch(cells_at != 0))
            store_cells(b.words + cells_at + from, lo, hi, m);
        vfloat far(3.0e38F);
        lo = select(m, lo, vvec{far, far, far});
        vfloat near(-3.0e38F);
        hi = select(m, hi, vvec{near, near, near});
        low.x = min(low.x, reduce_min(lo.x));
        low.y = min(low.y, reduce_min(lo.y));
        low.z = min(low.z, reduce_min(lo.z));
        high.x = max(high.x, reduce_max(hi.x));
        high.y = max(high.y, reduce_max(hi.y));
        high.z = max(high.z, reduce_max(hi.z));
    }
    sfloat lows[3] = {low.x, low.y, low.z};
    sfloat highs[3] = {high.x, high.y, high.z};
    for (int k = 0; k < 3; ++k) {
        pointer<float> box_low = field(b.header, &BlockHeader::box_low) + k;
        pointer<float> box_high = field(b.header, &BlockHeader::box_high) + k;
        sfloat least = load(box_low);
        store(box_low, min(lows[k], least));
        sfloat most = load(box_high);
        store(box_high, max(highs[k], most));
    }
}

/// The block's box, made to hold the ends of ancestors: where these move, so do the vertices between them.
inline void bound_ancestors(const Block& b) {
    svec low = load_svec(field(b.header, &BlockHeader::box_low));
    svec high = load_svec(field(b.header, &BlockHeader::box_high));
    pointer<float> ancestors = b.words + b.ancestors_at;
    for (int s = 0; s < 4; ++s) {
        sint quads = s % 2 == 0 ? b.quads_u : b.quads_v;
        sint hang = load(field(b.header, &BlockHeader::hang) + s); // 0 if the side is inside the patch
        if (branch((sint(1) << hang) > quads)) {
            for (int e = 0; e < 2; ++e) {
                svec end = load_svec(ancestors + (6 * s + 3 * e));
                low = {min(end.x, low.x), min(end.y, low.y), min(end.z, low.z)};
                high = {max(end.x, high.x), max(end.y, high.y), max(end.z, high.z)};
            }
        }
    }
    store_svec(ancestors + ancestor_box, low);
    store_svec(ancestors + (ancestor_box + 3), high);
}

/// How the blocks of a patch at one level look.
struct Shape {
    sint quads_u, quads_v;
    sint columns, rows; // of blocks
    sint stride;        // vertices
    sint cells_at, ancestors_at, middles_at, normals_at, lines;
    sint triangles;
};

inline Shape block_shape(const Dicing& d) {
    Shape s;
    s.quads_u = sint(1) << min(d.nu, block_log2);
    s.quads_v = sint(1) << min(d.nv, block_log2);
    s.columns = sint(1) << max(d.nu - block_log2, 0);
    s.rows = sint(1) << max(d.nv - block_log2, 0);
    s.stride = vertex_count(s.quads_u, s.quads_v);
    sbool several_cells = s.quads_u > 2;
    several_cells = several_cells | (s.quads_v > 2);
    sbool long_ancestor = false;
    for (int k = 0; k < 4; ++k) {
        sint segments = k % 2 == 0 ? s.quads_u : s.quads_v;
        long_ancestor = long_ancestor | ((sint(1) << d.side[k].hang) > segments);
    }
    sbool flat = d.kind >= static_cast<int>(PatchKind::flat_quad);
    sbool middles = d.level == d.coarsest;
    middles = middles & (half(d.side[0]) != 0);
    sint vertex_words = s.stride * 3;
    sint words = vertex_words + block_header_words;
    s.cells_at = select(several_cells, words, sint(0));
    words = words + select(several_cells, sint(6 * cell_boxes), sint(0));
    s.ancestors_at = select(long_ancestor, words, sint(0));
    words = words + select(long_ancestor, sint(ancestor_box + 6), sint(0));
    s.middles_at = select(middles, words, sint(0));
    words = words + select(middles, sint(ends_words), sint(0));
    s.normals_at = select(flat, sint(0), words);
    words = words + select(flat, sint(0), vertex_words);
    s.lines = (words + 15) >> 4;
    s.triangles = select(d.kind == static_cast<int>(PatchKind::flat_triangle), sint(1), sint(2));
    return s;
}

/// How far the vertices of one pass are from the means of their parents along any axis, at most.
inline sfloat pass_sway(const Block& b, pointer<std::int32_t> pass) {
    vfloat most(0.0F);
    sint n = load(pass);
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask m = first_lanes(n - from);
        BlendStep v = load_step(pass, from, m);
        vvec own = gather_vertex(b.x, b.stride, v.vertex, m);
        vvec one = gather_vertex(b.x, b.stride, v.one, m);
        vvec other = gather_vertex(b.x, b.stride, v.other, m);
        vvec mean = (one + other) * vfloat(0.5F);
        vvec away = abs(own - mean);
        most = max(select(m, largest(away), vfloat(0.0F)), most);
    }
    return reduce_max(most) * (1.0F + 1.0e-5F);
}

/// The box of a block's vertices, made wider along each axis: where its finer ones can be.
inline void bound_surface(const Block& b, const svec& deviation) {
    pointer<float> x = b.x;
    vfloat big(3.0e38F);
    vfloat small(-3.0e38F);
    sfloat wider[3] = {deviation.x, deviation.y, deviation.z};
    store(field(b.header, &BlockHeader::deviation), largest_component_of(deviation));
    for (int k = 0; k < 3; ++k) {
        vfloat low = big;
        vfloat high = small;
        for (sint from = 0; branch(from < b.stride); from += isa::width) {
            vmask m = first_lanes(b.stride - from);
            vfloat v = load_vector(x + from, m);
            low = min(select(m, v, big), low);
            high = max(select(m, v, small), high);
        }
        sfloat least = reduce_min(low);
        sfloat most = reduce_max(high);
        sfloat size = max(-least, most);
        sfloat slack = fma(size, 1.0e-6F, wider[k]); // owners' points differ from ours by rounding
        least = least - slack;
        most = most + slack;
        store(field(b.header, &BlockHeader::box_low) + k, least);
        store(field(b.header, &BlockHeader::box_high) + k, most);
        x = x + b.stride;
    }
}

/// The box of the limit surface under a block of less than 8 quads: that of the next level's vertices,
/// evaluated in scratch, and for all levels after it as much wider as these lie from the block's triangles,
/// along any axis: along one of its own a surface may leave them at later levels only. From level to level
/// deviations of a smooth surface fall to a quarter, beside extraordinary points at worst to about a half.
inline void bound_by_next_level(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint n = load(field(g.faces + d.face, &FaceRecord::control_count));
    Block next;
    next.header = b.header;
    next.quads_u = b.quads_u * 2;
    next.quads_v = b.quads_v * 2;
    next.stride = vertex_count(next.quads_u, next.quads_v);
    next.x = c.stack + (scratch_blend + block_header_words);
    sint finer_u = d.nu + 1;
    sint index = block_page_index(g, face_class, d.sub, finer_u, d.nv + 1, 0, 0);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
    weigh_all(g, weights, page_stride(next.stride), first, n, next.stride, next.x, next.stride);
    pointer<std::int32_t> passes = blend_table(c, next.quads_u, next.quads_v);
    sfloat deviation = pass_sway(next, passes + (blend_passes - 1) * pass_words);
    bound_surface(next, {deviation, deviation, deviation});
    store(field(b.header, &BlockHeader::deviation), deviation * 2.0F);
}

/// A bound on how far finer vertices lie from the triangles of a block of 8 quads along a side: sum over the
/// controls of the page's bound x the control's distance from the first one. One lane a control point.
inline svec summed_deviation(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint n = load(field(g.faces + d.face, &FaceRecord::control_count));
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
    pointer<float> row = page_weights(c, g, face_class, PageKind::deviation, index);
    sint origin = load(g.controls + first);
    vvec middle = load_broadcast_vec(g.points + origin * 3);
    vfloat zero(0.0F);
    vvec sum{zero, zero, zero};
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask m = first_lanes(n - from);
        vfloat bound = load_vector(row + from, m);
        vint point = load_vector(g.controls + (first + from), m);
        vint at = point * vint(3);
        vfloat x = gather(g.points, at, m);
        vfloat y = gather(g.points + 1, at, m);
        vfloat z = gather(g.points + 2, at, m);
        vvec away = vvec{x, y, z} - middle;
        if (branch(g.place.moved))
            away = moved_directions(g.place, away);
        away = select(m, abs(away), vvec{zero, zero, zero});
        sum = madd(bound, away, sum);
    }
    return {reduce_add(sum.x), reduce_add(sum.y), reduce_add(sum.z)};
}

/// The box of the limit surface under a block, whatever its sides make of it, as wide as all finer vertices
/// need.
inline void bound_limit(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    if (branch(max(d.nu, d.nv) < block_log2))
        bound_by_next_level(c, g, d, b);
    else
        bound_surface(b, summed_deviation(c, g, d, b));
}

/// The same of a bilinear patch: a quad of sides h and k deviates by twist x h k / 4 at its centre, and a
/// quarter of that at each finer level.
inline void bound_bilinear(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    svec corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = straight_corner(c, g, d, k);
    svec one = corner[0] + corner[2];
    svec other = corner[1] + corner[3];
    svec twist = one - other;
    sint quads_log2 = d.nu + d.nv;
    sfloat share = as_float((sint(127) - quads_log2) << 23) * 0.34F;
    bound_surface(b, {abs(twist.x) * share, abs(twist.y) * share, abs(twist.z) * share});
}

/// A box that holds nothing yet.
inline void clear_box(const Block& b) {
    store(field(b.header, &BlockHeader::deviation), 0.0F);
    for (int k = 0; k < 3; ++k) {
        store(field(b.header, &BlockHeader::box_low) + k, 3.0e38F);
        store(field(b.header, &BlockHeader::box_high) + k, -3.0e38F);
    }
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

/// How far the vertices of each pass are from the means of their parents, added up from the last pass on.
inline void measure_sway(const Context& c, const Block& b) {
    pointer<std::int32_t> pass = blend_table(c, b.quads_u, b.quads_v);
    sfloat off[blend_passes];
    for (int p = 0; p < blend_passes; ++p) {
        off[p] = pass_sway(b, pass);
        pass = pass + pass_words;
    }
    sfloat sum = 0.0F;
    for (int p = blend_passes - 1; p >= 0; --p) {
        sum = sum + off[p];
        store(field(b.header, &BlockHeader::sway) + (blend_passes - 1 - p), sum);
    }
}

/// How far corners that are middles of edges are from the means of the edges' ends.
inline sfloat middle_sway(const Context& c, const Dicing& d, const Shape& s, const Block& b, sint parent) {
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
            sint vertex = k == 0 ? b.quads_u : (b.quads_u + 1) * b.quads_v;
            pointer<float> mean = as<float>(root) + at + (ends_mean + 3 * k);
            for (int i = 0; i < 3; ++i) {
                sfloat own = load(b.x + b.stride * i + vertex);
                sfloat towards = load(mean + i);
                most = max(abs(own - towards), most);
            }
        }
    }
    return most;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
