// Opening a patch: exponents of its sides, then its blocks: positions, hanging vertices on coarser edges,
// ancestors, boxes. (Design: discrete levels. One level a mesh for now.)
#pragma once

#include "razor/kernels/surface.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// One side of a patch's grid of 2^n segments.
struct Side {
    sint curve = -1;
    sint flags = 0;
    sint exponent = 0; // of the whole curve
    sint hang = 0;     // log2 of grid segments on one segment of the curve
};

/// A patch about to be diced.
struct Dicing {
    sint patch, mesh, kind, face, sub;
    pointer<PatchRecord> record;
    Side side[4];
    sint nu = 0, nv = 0; // exponents of the grid
};

inline Side load_side(const Cage& g, pointer<PatchRecord> record, int s) {
    Side side;
    side.curve = load(field(record, &PatchRecord::side_curve) + s);
    side.flags = load(field(record, &PatchRecord::side_flags) + s);
    side.exponent = curve_exponent(g, g.curves + side.curve);
    return side;
}

inline sint half(const Side& side) {
    return (side.flags & side_half) >> 1;
}

/// Grid exponents: the larger of opposite sides, so that a side is never finer than the grid.
inline Dicing plan_dicing(const Context& c, const Cage& g, sint patch) {
    Dicing d;
    d.patch = patch;
    d.record = c.patches + patch;
    d.mesh = load(field(d.record, &PatchRecord::mesh));
    d.kind = load(field(d.record, &PatchRecord::kind));
    d.face = load(field(d.record, &PatchRecord::face));
    d.sub = load(field(d.record, &PatchRecord::sub));
    if (branch(d.kind >= static_cast<int>(PatchKind::flat_quad)))
        return d;
    for (int s = 0; s < 4; ++s)
        d.side[s] = load_side(g, d.record, s);
    sint e[4];
    for (int s = 0; s < 4; ++s)
        e[s] = d.side[s].exponent - half(d.side[s]);
    d.nu = max(max(e[0], e[2]), 0);
    d.nv = max(max(e[1], e[3]), 0);
    for (int s = 0; s < 4; ++s) {
        sint n = s % 2 == 0 ? d.nu : d.nv;
        // Edges of bilinear patches are straight at every level: one flat ancestor, the whole edge.
        sint flat = n + half(d.side[s]);
        if (branch(d.kind == static_cast<int>(PatchKind::bilinear)))
            d.side[s].exponent = 0;
        d.side[s].hang = flat - d.side[s].exponent;
    }
    return d;
}

inline sint vertex_count(sint quads_u, sint quads_v) {
    sint columns = quads_u + 1;
    return columns * quads_v + columns;
}

/// A block under construction.
struct Block {
    pointer<BlockHeader> header;
    pointer<float> words; // the same address
    pointer<float> x;     // first vertex array
    sint column, row;     // of the block in the patch
    sint quads_u, quads_v;
    sint stride;
    sint ancestors_at;
};

inline void scatter_vec(pointer<float> x, sint stride, vint at, const vvec& v, vmask m) {
    scatter(x, at, v.x, m);
    scatter(x + stride, at, v.y, m);
    scatter(x + stride * 2, at, v.z, m);
}

/// Positions of one side of a block from the side's curve, and the side's ancestor if it is longer than the
/// block. `strip`: the block along the side; `quads`: its segments; vertex i of the side is number first + i
/// * step of the block.
template <bool Straight>
inline void place_side(const Context& c, const Cage& g, const Block& b, const Side& side, int s, sint n,
                       sint strip, sint quads, sint first, sint step) {
    sint reversed = side.flags & side_reversed;
    sint total = sint(1) << (n + half(side)); // grid segments on the whole curve
    sint begin = strip * block_quads;
    if (branch(reversed != 0))
        begin = total - begin - quads;
    sint real_begin = begin >> side.hang; // segment of the curve in which the block's side begins
    sint chunk = real_begin >> block_log2;
    pointer<float> points = curve_points<Straight>(c, g, g.curves + side.curve, side.exponent, chunk);
    sint chunk_begin = chunk * block_quads;
    sint below = (sint(1) << side.hang) - 1;
    sfloat per_segment = as_float((sint(127) - side.hang) << 23); // 2^-hang
    for (int lanes = 0; lanes < block_side; lanes += isa::width) {
        vint i = lane_index() + vint(lanes);
        vmask m = i <= vint(quads);
        vint along = i + vint(begin); // in the curve's direction
        vint hang = vint(side.hang);
        vint real = along >> hang;
        vint from = real - vint(chunk_begin);
        vint rest = along & vint(below);
        vmask between = rest > vint(0);
        vfloat f = to_float(rest);
        f = f * vfloat(per_segment);
        vfloat g0 = vfloat(1.0F) - f;
        vmask next = m & between;
        vvec p;
        for (int k = 0; k < 3; ++k) {
            vfloat a = gather(points + k * curve_row, from, m);
            vfloat z = gather(points + k * curve_row + 1, from, next);
            vfloat near = a * g0; // unfused: the same bits from either end
            vfloat blend = near + z * f;
            vfloat r = select(between, blend, a);
            (k == 0 ? p.x : k == 1 ? p.y : p.z) = r;
        }
        vint back = vint(quads) - i;
        vint place = select(vmask(reversed != 0), back, i);
        vint at = place * vint(step);
        at = at + vint(first);
        scatter_vec(b.x, b.stride, at, p, m);
    }
    if (branch((sint(1) << side.hang) > quads)) {
        sint from = real_begin - chunk_begin;
        svec a = get_point(points, from);
        svec z = get_point(points, from + 1);
        pointer<float> out = b.words + b.ancestors_at + 6 * s;
        pointer<float> low = out;
        pointer<float> high = out + 3;
        if (branch(reversed != 0)) {
            low = out + 3;
            high = out;
        }
        store(low, a.x);
        store(low + 1, a.y);
        store(low + 2, a.z);
        store(high, z.x);
        store(high + 1, z.y);
        store(high + 2, z.z);
    }
}

/// The strip number of block column (or row) `block` in a grid of exponent n.
inline sint strip_of(sint n, sint block) {
    sint before = n;
    if (branch(n > block_log2))
        before = strip_first_large(sint(1) << (n - block_log2));
    return before + block;
}

/// Index of a block's page within its section.
inline sint block_page_index(const Cage& g, sint face_class, sint sub, sint nu, sint nv, sint column,
                             sint row) {
    sint strips = load(field(g.classes + face_class, &ClassRecord::strips));
    sint su = strip_of(nu, column);
    sint sv = strip_of(nv, row);
    return (sub * strips + su) * strips + sv;
}

/// Rows of a page hold this many floats.
inline sint page_stride(sint vertices) {
    return (vertices + (isa::width - 1)) & -isa::width;
}

/// sum over controls of weight x point for `Vectors` vectors of block vertices from `from` on, stored to x,
/// y, z arrays.
template <int Vectors>
inline void weigh(const Cage& g, pointer<float> weights, sint row_stride, sint controls_first, sint controls,
                  sint from, sint vertices, pointer<float> x, sint stride) {
    vvec sum[Vectors];
    vmask m[Vectors];
    for (int v = 0; v < Vectors; ++v) {
        sum[v] = {vfloat(0.0F), vfloat(0.0F), vfloat(0.0F)};
        m[v] = first_lanes(vertices - from - v * isa::width);
    }
    pointer<float> row = weights + from;
    for (sint i = 0; branch(i < controls); ++i) {
        sint point = load(g.controls + (controls_first + i));
        vvec p = load_broadcast_vec(g.points + point * 3);
        for (int v = 0; v < Vectors; ++v) {
            vfloat w = load_vector(row + v * isa::width, m[v]);
            sum[v] = madd(w, p, sum[v]);
        }
        row = row + row_stride;
    }
    pointer<float> out = x + from;
    for (int v = 0; v < Vectors; ++v) {
        store_vector(out + v * isa::width, sum[v].x, m[v]);
        store_vector(out + stride + v * isa::width, sum[v].y, m[v]);
        store_vector(out + stride * 2 + v * isa::width, sum[v].z, m[v]);
    }
}

/// All vertices of a row-major array of `vertices`, three vectors at a time where there is work for them.
inline void weigh_all(const Cage& g, pointer<float> weights, sint row_stride, sint controls_first,
                      sint controls, sint vertices, pointer<float> x, sint stride) {
    constexpr int w = isa::width;
    sint from = 0;
    for (; branch(vertices - from > 2 * w); from += 3 * w)
        weigh<3>(g, weights, row_stride, controls_first, controls, from, vertices, x, stride);
    if (branch(vertices - from > w)) {
        weigh<2>(g, weights, row_stride, controls_first, controls, from, vertices, x, stride);
    } else if (branch(vertices > from)) {
        weigh<1>(g, weights, row_stride, controls_first, controls, from, vertices, x, stride);
    }
}

/// Corner k of a straight-edged patch.
inline svec straight_corner(const Context& c, const Cage& g, const Dicing& d, int k) {
    sint corner = load(field(d.record, &PatchRecord::corner) + k);
    sint half_side = half(d.side[0]);
    if (branch(half_side != 0)) {
        if (k == 1 || k == 3)
            return edge_middle<true>(c, g, g.curves + corner);
        if (k == 2)
            return face_centre<true>(c, g, g.faces + corner);
    }
    return cage_point(g, corner);
}

/// Column and row of block vertices first + lane, for columns 0 ... quads_u.
inline void vertex_place(sint quads_u, vint vertex, vint& column, vint& row) {
    // quads_u + 1 is 2, 3, 5 or 9: division by multiplication is exact for the 81 vertices of a block.
    vfloat per_row = reciprocal(vfloat(to_float(quads_u + 1)));
    vfloat guess = (to_float(vertex) + 0.5F) * per_row;
    row = to_int(guess);
    column = vertex - row * vint(quads_u + 1);
}

/// Bilinear interpolation of four corners over the block's vertices.
inline void place_bilinear(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    vvec corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = broadcast(straight_corner(c, g, d, k));
    sfloat du = as_float((sint(127) - d.nu) << 23);
    sfloat dv = as_float((sint(127) - d.nv) << 23);
    sint vertices = b.stride;
    sint column0 = b.column * block_quads;
    sint row0 = b.row * block_quads;
    for (sint from = 0; branch(from < vertices); from += isa::width) {
        vmask m = first_lanes(vertices - from);
        vint vertex = lane_index() + vint(from);
        vint column, row;
        vertex_place(b.quads_u, vertex, column, row);
        column = column + vint(column0);
        row = row + vint(row0);
        vfloat u = to_float(column);
        u = u * vfloat(du);
        vfloat v = to_float(row);
        v = v * vfloat(dv);
        vfloat u0 = vfloat(1.0F) - u;
        vfloat v0 = vfloat(1.0F) - v;
        vvec low = madd(u, corner[1], corner[0] * u0);
        vvec high = madd(u, corner[2], corner[3] * u0);
        vvec p = madd(v, high, low * v0);
        store_vector(b.x + from, p.x, m);
        store_vector(b.x + b.stride + from, p.y, m);
        store_vector(b.x + b.stride * 2 + from, p.z, m);
    }
}

/// The cage points of a flat quad (or triangle: three) as a block of one quad: (0,0), (1,0), (0,1), (1,1).
inline void place_flat(const Cage& g, const Dicing& d, const Block& b) {
    constexpr int corner_of_vertex[4] = {0, 1, 3, 2};
    for (int v = 0; v < 4; ++v) {
        sint corner = load(field(d.record, &PatchRecord::corner) + corner_of_vertex[v]);
        svec p = cage_point(g, corner);
        store(b.x + v, p.x);
        store(b.x + b.stride + v, p.y);
        store(b.x + b.stride * 2 + v, p.z);
    }
}

template <bool Straight>
inline void place_sides(const Context& c, const Cage& g, const Dicing& d, const Block& b) {
    sint columns = sint(1) << max(d.nu - block_log2, 0);
    sint rows = sint(1) << max(d.nv - block_log2, 0);
    sint width = b.quads_u + 1;
    if (branch(b.row == 0))
        place_side<Straight>(c, g, b, d.side[0], 0, d.nu, b.column, b.quads_u, 0, 1);
    if (branch(b.row == rows - 1))
        place_side<Straight>(c, g, b, d.side[2], 2, d.nu, b.column, b.quads_u, width * b.quads_v, 1);
    if (branch(b.column == 0))
        place_side<Straight>(c, g, b, d.side[3], 3, d.nv, b.row, b.quads_v, 0, width);
    if (branch(b.column == columns - 1))
        place_side<Straight>(c, g, b, d.side[1], 1, d.nv, b.row, b.quads_v, b.quads_u, width);
}

/// Boxes of the block's cells (stored if there are several) and of the block. One lane a cell.
inline void bound_block(const Block& b, sint cells_at) {
    sint cells_u = (b.quads_u + 1) >> 1;
    sint cells_v = (b.quads_v + 1) >> 1;
    sint cells = cells_u * cells_v;
    sbool wide = cells_u > 2;
    sint shift = select(wide, sint(2), cells_u - 1); // log2(cells_u) of 1, 2, 4
    svec low{sfloat(3.0e38F), sfloat(3.0e38F), sfloat(3.0e38F)};
    svec high{sfloat(-3.0e38F), sfloat(-3.0e38F), sfloat(-3.0e38F)};
    sint width = b.quads_u + 1;
    for (sint from = 0; branch(from < cells); from += isa::width) {
        vmask m = first_lanes(cells - from);
        vint cell = lane_index() + vint(from);
        vint row = cell >> vint(shift);
        vint column = cell - (row << vint(shift));
        vvec lo{vfloat(3.0e38F), vfloat(3.0e38F), vfloat(3.0e38F)};
        vvec hi{vfloat(-3.0e38F), vfloat(-3.0e38F), vfloat(-3.0e38F)};
        for (int j = 0; j < 3; ++j) {
            vint vertex_row = (row << 1) + vint(j);
            vertex_row = min(vertex_row, vint(b.quads_v));
            vint row_begin = vertex_row * vint(width);
            for (int i = 0; i < 3; ++i) {
                vint vertex_column = (column << 1) + vint(i);
                vertex_column = min(vertex_column, vint(b.quads_u));
                vint at = row_begin + vertex_column;
                vfloat x = gather(b.x, at, m);
                vfloat y = gather(b.x + b.stride, at, m);
                vfloat z = gather(b.x + b.stride * 2, at, m);
                lo = {min(x, lo.x), min(y, lo.y), min(z, lo.z)};
                hi = {max(x, hi.x), max(y, hi.y), max(z, hi.z)};
            }
        }
        if (branch(cells_at != 0)) {
            pointer<float> out = b.words + cells_at + from;
            store_vector(out, lo.x, m);
            store_vector(out + cell_boxes, lo.y, m);
            store_vector(out + 2 * cell_boxes, lo.z, m);
            store_vector(out + 3 * cell_boxes, hi.x, m);
            store_vector(out + 4 * cell_boxes, hi.y, m);
            store_vector(out + 5 * cell_boxes, hi.z, m);
        }
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
    pointer<float> box_low = field(b.header, &BlockHeader::box_low);
    store(box_low, low.x);
    store(box_low + 1, low.y);
    store(box_low + 2, low.z);
    pointer<float> box_high = field(b.header, &BlockHeader::box_high);
    store(box_high, high.x);
    store(box_high + 1, high.y);
    store(box_high + 2, high.z);
}

/// Dices one patch into blocks and fills in its entry of the tree's table (all but the state).
[[gnu::noinline]] inline void dice_patch(const Context& c, sint patch, pointer<OpenPatch> entry) {
    phase_scope phase(phase_tessellate);
    sint mesh = load(field(c.patches + patch, &PatchRecord::mesh));
    Cage g = load_cage(c, mesh);
    Dicing d = plan_dicing(c, g, patch);
    sbool flat = d.kind >= static_cast<int>(PatchKind::flat_quad);
    sint quads_u = sint(1) << min(d.nu, block_log2);
    sint quads_v = sint(1) << min(d.nv, block_log2);
    sint columns = sint(1) << max(d.nu - block_log2, 0);
    sint rows = sint(1) << max(d.nv - block_log2, 0);
    sint stride = vertex_count(quads_u, quads_v);

    sbool several_cells = quads_u > 2;
    several_cells = several_cells | (quads_v > 2);
    sbool long_ancestor = false;
    for (int s = 0; s < 4; ++s) {
        sint segments = s % 2 == 0 ? quads_u : quads_v;
        long_ancestor = long_ancestor | ((sint(1) << d.side[s].hang) > segments);
    }
    sint vertex_words = stride * 3;
    sint words = vertex_words + block_header_words;
    sint cells_at = select(several_cells, words, sint(0));
    words = words + select(several_cells, sint(6 * cell_boxes), sint(0));
    sint ancestors_at = select(long_ancestor, words, sint(0));
    words = words + select(long_ancestor, sint(24), sint(0));
    sint normals_at = select(flat, sint(0), words);
    words = words + select(flat, sint(0), vertex_words);
    sint lines = (words + 15) >> 4;
    sint blocks = columns * rows;
    sint all_lines = lines * blocks;
    sint first_line =
        allocate(c, &WorkerRecord::grid_next, &WorkerRecord::grid_end, all_lines, trap_grids_full);
    sint is_triangle = select(d.kind == static_cast<int>(PatchKind::flat_triangle), sint(1), sint(2));

    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint control_first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint control_count = load(field(g.faces + d.face, &FaceRecord::control_count));

    Block b;
    b.quads_u = quads_u;
    b.quads_v = quads_v;
    b.stride = stride;
    b.ancestors_at = ancestors_at;
    sint number = 0;
    for (b.row = 0; branch(b.row < rows); ++b.row) {
        for (b.column = 0; branch(b.column < columns); ++b.column) {
            pointer<Line> line = c.grids + (first_line + number * lines);
            b.header = as<BlockHeader>(line);
            b.words = as<float>(line);
            b.x = b.words + block_header_words;
            store(field(b.header, &BlockHeader::patch), patch);
            store(field(b.header, &BlockHeader::number), number);
            store(field(b.header, &BlockHeader::mesh), mesh);
            store(field(b.header, &BlockHeader::quads_u), quads_u);
            store(field(b.header, &BlockHeader::quads_v), quads_v);
            store(field(b.header, &BlockHeader::triangles), is_triangle);
            store(field(b.header, &BlockHeader::stride), stride);
            store(field(b.header, &BlockHeader::cells_at), cells_at);
            store(field(b.header, &BlockHeader::ancestors_at), ancestors_at);
            store(field(b.header, &BlockHeader::normals_at), normals_at);
            store_release(field(b.header, &BlockHeader::normals), absent);
            // Only sides on the patch's border can hang.
            sint hang[4];
            hang[0] = select(b.row == 0, d.side[0].hang, sint(0));
            hang[1] = select(b.column == columns - 1, d.side[1].hang, sint(0));
            hang[2] = select(b.row == rows - 1, d.side[2].hang, sint(0));
            hang[3] = select(b.column == 0, d.side[3].hang, sint(0));
            sint hangs = 0;
            for (int s = 0; s < 4; ++s) {
                hangs = hangs | hang[s];
                store(field(b.header, &BlockHeader::hang) + s, hang[s]);
            }
            store(field(b.header, &BlockHeader::hangs), hangs);
            if (branch(flat)) {
                place_flat(g, d, b);
            } else if (branch(d.kind == static_cast<int>(PatchKind::bilinear))) {
                place_bilinear(c, g, d, b);
                place_sides<true>(c, g, d, b);
            } else {
                sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
                pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
                weigh_all(g, weights, page_stride(stride), control_first, control_count, stride, b.x, stride);
                place_sides<false>(c, g, d, b);
            }
            bound_block(b, cells_at);
            ++number;
        }
    }
    store(field(entry, &OpenPatch::first_line), first_line);
    store(field(entry, &OpenPatch::blocks), blocks);
    store(field(entry, &OpenPatch::block_lines), lines);
    tally(c.counters->patches_opened, 1);
    tally(c.counters->blocks_made, blocks);
    tally(c.counters->vertices_made, blocks * stride);
    sint quads = quads_u * quads_v;
    tally(c.counters->triangles_made, blocks * is_triangle * quads);
}

/// Returns once the patch is open in the worker's tree, opening it if nobody else does.
inline pointer<OpenPatch> open_patch(const Context& c, sint patch) {
    pointer<OpenPatch> entry = c.open + patch;
    build_once(field(entry, &OpenPatch::state), [&] { dice_patch(c, patch, entry); });
    return entry;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
