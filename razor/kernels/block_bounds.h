// What a block says of where its vertices and all finer ones can be: boxes of cells, how far finer levels
// leave its triangles, and how far its vertices can leave their anchors.
#pragma once

#include "razor/kernels/block_corners.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

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

/// Boxes of the block's cells, stored if there are several; returns that of all. One lane a cell.
inline Box bound_block(const Block& b, sint cells_at) {
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
    return {low, high};
}

/// Cells before the middle, or from it on.
inline vmask half_of(const vint& cell, sint middle, sint which) {
    vmask beyond = cell >= vint(middle);
    return beyond ^ vmask(which == 0);
}

/// The box of a block's vertices, or of those of a part, as they lie. A block of several cells can be halved.
inline Box vertices_of(pointer<BlockHeader> block, const Part& part = {}) {
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint several = load(field(block, &BlockHeader::cells_at));
    sint stride = load(field(block, &BlockHeader::stride));
    sint shift = cells_shift(quads_u);
    sint rows = (quads_v + 1) >> 1;
    sint cells = rows << shift;
    // Of cells, or of the vertices of a block that is one.
    sint n = select(several != 0, cells, stride);
    sint step = select(several != 0, sint(cell_boxes), stride);
    sint lows_at = select(several != 0, several, sint(block_header_words));
    pointer<float> lows = as<float>(block) + lows_at;
    sint highs_at = step * 3;
    highs_at = select(several != 0, highs_at, sint(0));
    pointer<float> highs = lows + highs_at;
    sint middle_u = (sint(1) << shift) >> 1;
    sint middle_v = rows >> 1;
    vfloat big(3.0e38F);
    vfloat least[3] = {big, big, big};
    vfloat most[3] = {-big, -big, -big};
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask m = first_lanes(n - from);
        vint cell = lane_index() + vint(from);
        vint row = cell >> vint(shift);
        vint column = cell - (row << vint(shift));
        if (branch(part.u >= 0))
            m = m & half_of(column, middle_u, part.u);
        if (branch(part.v >= 0))
            m = m & half_of(row, middle_v, part.v);
        pointer<float> low_at = lows + from;
        pointer<float> high_at = highs + from;
        for (int k = 0; k < 3; ++k) {
            vfloat low = load_vector(low_at, m);
            least[k] = min(select(m, low, big), least[k]);
            vfloat high = load_vector(high_at, m);
            most[k] = max(select(m, high, -big), most[k]);
            low_at = low_at + step;
            high_at = high_at + step;
        }
    }
    Box box;
    box.low = {reduce_min(least[0]), reduce_min(least[1]), reduce_min(least[2])};
    box.high = {reduce_max(most[0]), reduce_max(most[1]), reduce_max(most[2])};
    return box;
}

/// Number of a part among the four.
inline sint part_number(const Part& part) {
    sint u = max(part.u, 0);
    sint v = max(part.v, 0);
    return v * 2 + u;
}

/// Boxes of the parts of a block as it lies now, its sides on the surface.
inline void bound_parts(const Block& b, const Shape& s) {
    bound_block(b, s.cells_at);
    pointer<float> out = b.words + parts_at(s.normals_at);
    sint columns = select(s.quads_u == block_quads, sint(2), sint(1));
    sint rows = select(s.quads_v == block_quads, sint(2), sint(1));
    for (sint j = 0; branch(j < rows); ++j) {
        for (sint i = 0; branch(i < columns); ++i) {
            Part part;
            part.u = select(columns > 1, i, sint(-1));
            part.v = select(rows > 1, j, sint(-1));
            Box box = vertices_of(b.header, part);
            pointer<float> to = out + part_number(part) * 6;
            store_svec(to, box.low);
            store_svec(to + 3, box.high);
        }
    }
}

/// The box of a part of a block's surface, but for how far finer vertices lie from its triangles.
inline Box surface_of(pointer<BlockHeader> block, const Part& part) {
    sint hangs = load(field(block, &BlockHeader::hangs));
    if (branch(hangs == 0))
        return vertices_of(block, part);
    sint normals_at = load(field(block, &BlockHeader::normals_at));
    pointer<float> at = as<float>(block) + parts_at(normals_at);
    at = at + part_number(part) * 6;
    Box box;
    box.low = load_svec(at);
    box.high = load_svec(at + 3);
    return box;
}

/// The block's box, made to hold the ends of ancestors: where these move, so do the vertices between them.
inline void bound_ancestors(const Block& b) {
    Box box = box_of(b.header);
    svec low = box.low;
    svec high = box.high;
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
        sfloat slack = fma(size, few_roundings, wider[k]); // owners' points differ from ours by rounding
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
/// controls of the page's bound x how far the control is from the affine map of the parameters that fits
/// all of them best, to which nothing deviates; of an irregular face, from their mean. One lane a control.
inline svec summed_deviation(const Context& c, const Cage& g, const Dicing& d, sint column, sint row) {
    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint n = load(field(g.faces + d.face, &FaceRecord::control_count));
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, column, row);
    pointer<float> bounds = page_weights(c, g, face_class, PageKind::deviation, index);
    sint rows = (n + 63) & -64;
    pointer<float> along_u = bounds + rows;
    pointer<float> along_v = along_u + rows;
    sint origin = load(g.controls + first);
    vvec begin = load_broadcast_vec(g.points + origin * 3);
    vfloat zero(0.0F);
    svec mean{sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
    svec du = mean;
    svec dv = mean;
    auto away_from_first = [&](sint from, const vmask& m) {
        vint point = load_vector(g.controls + (first + from), m);
        vint at = point * vint(3);
        vfloat x = gather(g.points, at, m);
        vfloat y = gather(g.points + 1, at, m);
        vfloat z = gather(g.points + 2, at, m);
        vvec away = vvec{x, y, z} - begin;
        if (branch(g.place.moved))
            away = moved_directions(g.place, away);
        return select(m, away, vvec{zero, zero, zero});
    };
    auto added = [](const vvec& v) { return svec{reduce_add(v.x), reduce_add(v.y), reduce_add(v.z)}; };
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask m = first_lanes(n - from);
        vvec away = away_from_first(from, m);
        vfloat u = load_vector(along_u + from, m);
        vfloat v = load_vector(along_v + from, m);
        mean = mean + added(away);
        du = du + added(away * u);
        dv = dv + added(away * v);
    }
    mean = mean * (sfloat(1.0F) / to_float(n));
    vvec sum{zero, zero, zero};
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask m = first_lanes(n - from);
        vfloat bound = load_vector(bounds + from, m);
        vfloat u = load_vector(along_u + from, m);
        vfloat v = load_vector(along_v + from, m);
        vvec away = away_from_first(from, m);
        away = away - broadcast(mean);
        away = away - broadcast(du) * u;
        away = away - broadcast(dv) * v;
        away = select(m, abs(away), vvec{zero, zero, zero});
        sum = madd(bound, away, sum);
    }
    return added(sum);
}

/// The box of the limit surface under a block, whatever its sides make of it, as wide as all finer vertices
/// need.
inline void bound_limit(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    if (branch(max(d.nu, d.nv) < block_log2))
        bound_by_next_level(c, g, d, b);
    else
        bound_surface(b, summed_deviation(c, g, d, b.column, b.row));
}

/// How far finer vertices lie from the triangles of a bilinear patch, along each axis: a quad of sides h and
/// k deviates by twist x h k / 4 at its centre, and a quarter of that at each finer level.
inline svec bilinear_deviation(const Context& c, const Cage& g, const Dicing& d) {
    svec corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = straight_corner(c, g, d, k);
    svec one = corner[0] + corner[2];
    svec other = corner[1] + corner[3];
    svec twist = one - other;
    sint quads_log2 = d.nu + d.nv;
    sfloat share = as_float((sint(127) - quads_log2) << 23) * 0.34F;
    return {abs(twist.x) * share, abs(twist.y) * share, abs(twist.z) * share};
}

/// The box of a block before its sides are placed, as wide as all finer vertices need.
inline void bound_finer(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    if (branch(d.kind == static_cast<int>(PatchKind::bilinear)))
        bound_surface(b, bilinear_deviation(c, g, d));
    else
        bound_limit(c, g, d, b);
}

/// How far finer vertices lie from a block's triangles, along each axis, and by rounding; `finer`: how its
/// patch is diced one level down.
inline svec deviation_of(const Context& c, const Cage& g, const Dicing& finer, pointer<BlockHeader> block) {
    Box box = box_of(block);
    sfloat size = largest_component_of(box.low);
    size = max(largest_component_of(box.high), size);
    sfloat rounding = size * few_roundings;
    Dicing d = finer;
    d.nu = d.nu - 1;
    d.nv = d.nv - 1;
    sfloat known = load(field(block, &BlockHeader::deviation));
    known = max(known, 0.0F);
    if (branch(d.displaced)) {
        sint normals_at = load(field(block, &BlockHeader::normals_at));
        sfloat kept = load(as<float>(block) + (normals_at - 1));
        return {kept, kept, kept};
    }
    svec deviation{known, known, known};
    if (branch(d.kind == static_cast<int>(PatchKind::bilinear))) {
        deviation = bilinear_deviation(c, g, d);
    } else if (branch(max(d.nu, d.nv) >= block_log2)) {
        sint column = load(field(block, &BlockHeader::column));
        sint row = load(field(block, &BlockHeader::row));
        deviation = summed_deviation(c, g, d, column, row);
    }
    return {deviation.x + rounding, deviation.y + rounding, deviation.z + rounding};
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

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
