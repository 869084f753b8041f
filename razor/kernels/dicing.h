// How a patch is diced at a level: exponents of its sides, and where the vertices of a block lie: on the
// limit surface, on a bilinear patch, and on its sides where their owners put them.
#pragma once

#include "razor/kernels/blend_order.h"
#include "razor/kernels/surface.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// One side of a patch's grid of 2^n segments, at one level.
struct Side {
    sint curve = -1;
    sint flags = 0;
    sint whole = straight_curve; // exponent of the whole curve at level 0
    sint exponent = 0;           // of the whole curve at this level
    sint hang = 0;               // log2 of grid segments on one segment of the curve
};

/// A patch about to be diced at one level.
struct Dicing {
    sint patch, instance, kind, face, sub;
    pointer<PatchRecord> record;
    Side side[4];
    sint level = 0, coarsest = 0; // the level, and the last one that the patch has
    sint nu = 0, nv = 0;          // exponents of the grid
    sint shading;                 // see InstanceRecord
    sbool displaced;
};

inline sint half(const Side& side) {
    return (side.flags & side_half) >> 1;
}

/// What is known of an instance's patch once for all instances of its mesh.
inline pointer<PatchRecord> patch_record(const Context& c, sint instance, sint patch) {
    pointer<InstanceRecord> record = c.instances + instance;
    sint first = load(field(record, &InstanceRecord::first_patch));
    sint begin = load(field(record, &InstanceRecord::first_record));
    return c.patches + (begin + (patch - first));
}

inline sbool is_flat(const Dicing& d) {
    return d.kind >= static_cast<int>(PatchKind::flat_quad);
}

/// Grid exponents at level 0: the larger of opposite sides, so that a side is never finer than the grid. They
/// differ by block_log2 at most, so that the coarsest level is one block. `level` -1: the coarsest.
inline Dicing plan_dicing(const Context& c, const Cage& g, sint instance, sint patch, sint level) {
    Dicing d;
    d.patch = patch;
    d.instance = instance;
    d.record = patch_record(c, instance, patch);
    d.kind = load(field(d.record, &PatchRecord::kind));
    d.face = load(field(d.record, &PatchRecord::face));
    d.sub = load(field(d.record, &PatchRecord::sub));
    d.displaced = g.displaced;
    d.shading = load(field(c.instances + instance, &InstanceRecord::shading));
    if (branch(is_flat(d)))
        return d;
    // Edges of bilinear patches are straight at every level: one flat ancestor, the whole edge.
    sbool straight = d.kind == static_cast<int>(PatchKind::bilinear);
    sint e[4];
    for (int s = 0; s < 4; ++s) {
        Side& side = d.side[s];
        side.curve = load(field(d.record, &PatchRecord::side_curve) + s);
        side.flags = load(field(d.record, &PatchRecord::side_flags) + s);
        side.whole = curve_exponent(c, g, side.curve, straight);
        e[s] = side.whole - half(side);
    }
    sint across = max(max(e[1], e[3]), 0);
    d.nu = max(max(e[0], e[2]), 0);
    d.nv = max(across, d.nu - block_log2);
    d.nu = max(d.nu, d.nv - block_log2);
    d.coarsest = min(d.nu, d.nv);
    d.level = select(level < 0, d.coarsest, level);
    d.nu = d.nu - d.level;
    d.nv = d.nv - d.level;
    for (int s = 0; s < 4; ++s) {
        Side& side = d.side[s];
        sint flat = (s % 2 == 0 ? d.nu : d.nv) + half(side);
        side.exponent = select(straight, sint(0), max(side.whole - d.level, 0));
        side.whole = select(straight, sint(straight_curve), side.whole);
        side.hang = flat - side.exponent;
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
    sint corners_at, ancestors_at;
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
    for (int lanes = 0; lanes < block_side; lanes += isa::width) {
        vint i = lane_index() + vint(lanes);
        vmask m = i <= vint(quads);
        vint along = i + vint(begin); // in the curve's direction
        vint hang = vint(side.hang);
        vint real = along >> hang;
        vint from = real - vint(chunk_begin);
        vint rest = along & vint(below);
        vmask between = rest > vint(0);
        vmask next = m & between;
        vvec p, z;
        for (int k = 0; k < 3; ++k) {
            vfloat from_curve = gather(points + k * curve_row, from, m);
            vfloat end = gather(points + k * curve_row + 1, from, next);
            (k == 0 ? p.x : k == 1 ? p.y : p.z) = from_curve;
            (k == 0 ? z.x : k == 1 ? z.y : z.z) = end;
        }
        // A hanging vertex is the mean of its parents, and they of theirs.
        for (sint h = side.hang; branch(h > 0); --h) {
            vvec mean = (p + z) * vfloat(0.5F);
            vint bit = rest >> vint(h - 1);
            vmask upper = (bit & vint(1)) != vint(0);
            p = select(upper, mean, p);
            z = select(upper, z, mean);
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
        store_svec(low, a);
        store_svec(high, z);
    }
}

/// The strip number of block column (or row) `block` in a grid of exponent n.
inline sint strip_of(sint n, sint block) {
    sint before = n;
    if (branch(n > block_log2))
        before = strip_first_large(sint(1) << (n - block_log2));
    return before + block;
}

/// Index of a block's page, of any kind that blocks have.
inline sint block_page_index(const Cage& g, sint face_class, sint sub, sint nu, sint nv, sint column,
                             sint row) {
    sint subs = load(field(g.classes + face_class, &ClassRecord::subs));
    sint su = strip_of(nu, column);
    sint sv = strip_of(nv, row);
    sbool along_v = su < sv; // strip_pair(su, sv)
    sint larger = select(along_v, sv, su);
    sint beyond = select(along_v, su + 1, sint(0));
    sint pair = larger * larger + sv + beyond;
    return (pair * subs + sub) * block_kinds;
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
    if (branch(g.place.moved)) {
        for (vvec& p : sum)
            p = moved_points(g.place, p);
    }
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
            return edge_middle<true>(c, g, corner);
        if (k == 2)
            return face_centre<true>(c, g, corner);
    }
    return placed_point(g, corner);
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
        svec p = placed_point(g, corner);
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

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
