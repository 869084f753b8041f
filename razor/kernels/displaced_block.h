// Blocks of displaced surfaces: where their vertices lie, and how far finer ones can be from them.
//
// A finer vertex lies at S + h N: S on the limit surface, whose distance e from the block's triangles is
// bounded as of any block (block_bounds.h); h within `height` of the heights at the corners of the quad about
// it; N within `turn` of what lies between their normals. So it is no further from the hull of the block's
// vertices than e + height + |h| turn. Sides have heights and normals as their owners have them, which over
// seams and creases are others: they are bounded by their own, and where these differ from the block's own,
// both count.
#pragma once

#include "razor/kernels/block_bounds.h"
#include "razor/kernels/texcoords.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

inline pointer<float> displaced_array(const Context& c, const Block& b, int array) {
    sint at = b.stride * array + scratch_displaced;
    return c.stack + at;
}

/// Own vertices of a block, on the surface, displaced, and all that made them, in scratch.
inline void weigh_displaced(const Context& c, const Cage& g, const Dicing& d, const Displacing& displacing,
                            const Block& b) {
    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint controls = load(field(g.faces + d.face, &FaceRecord::control_count));
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
    pointer<float> derivatives = page_weights(c, g, face_class, PageKind::derivative, index);
    sint row_stride = page_stride(b.stride);
    sint shift = texture_shift(c, g);
    pointer<float> texcoords = displaced_array(c, b, displaced_texcoord);
    make_texcoords(c, g, d, b, shift, texcoords);
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vfloat zero(0.0F);
        vvec p{zero, zero, zero};
        vvec du = p;
        vvec dv = p;
        pointer<float> row = weights + from;
        pointer<float> rows = derivatives + from;
        for (sint i = 0; branch(i < controls); ++i) {
            sint point = load(g.controls + (first + i));
            vvec at = load_broadcast_vec(g.points + point * 3);
            vfloat w = load_vector(row, m);
            p = madd(w, at, p);
            vfloat wu = load_vector(rows, m);
            du = madd(wu, at, du);
            vfloat wv = load_vector(rows + row_stride, m);
            dv = madd(wv, at, dv);
            row = row + row_stride;
            rows = rows + row_stride * 2;
        }
        vpoint uv;
        pointer<float> coordinates = texcoords + from;
        uv.u = load_vector(coordinates, m);
        uv.v = load_vector(coordinates + b.stride, m);
        Displaced q = displaced(displacing, p, du, dv, uv, m);
        if (branch(g.place.moved)) {
            p = moved_points(g.place, p);
            q.point = moved_points(g.place, q.point);
        }
        auto put = [&](pointer<float> to, const vvec& v) {
            store_vector(to, v.x, m);
            store_vector(to + b.stride, v.y, m);
            store_vector(to + b.stride * 2, v.z, m);
        };
        put(displaced_array(c, b, displaced_surface) + from, p);
        put(displaced_array(c, b, displaced_normal) + from, q.normal);
        put(b.x + from, q.point);
    }
}

/// How far heights and normals of finer vertices are from those of a block's own.
struct Turning {
    sfloat height, turn;
};
inline Turning turning_of(const Context& c, const Displacing& displacing, const Block& b) {
    pointer<float> normals = displaced_array(c, b, displaced_normal);
    pointer<float> uv = displaced_array(c, b, displaced_texcoord);
    vfloat zero(0.0F);
    vfloat along_u[2] = {zero, zero};
    vfloat along_v[2] = {zero, zero};
    vfloat reach = zero;
    vfloat turns = zero;
    sint width = b.quads_u + 1;
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vint vertex = lane_index() + vint(from);
        vint column, row;
        vertex_place(b.quads_u, vertex, column, row);
        vmask right = m & (column < vint(b.quads_u));
        vmask up = m & (row < vint(b.quads_v));
        for (int k = 0; k < 2; ++k) {
            pointer<float> at = uv + b.stride * k;
            vfloat here = load_vector(at + from, m);
            vfloat next = gather(at + 1, vertex, right);
            along_u[k] = max(select(right, abs(next - here), zero), along_u[k]);
            next = gather(at + width, vertex, up);
            along_v[k] = max(select(up, abs(next - here), zero), along_v[k]);
            reach = max(select(m, abs(here), zero), reach);
        }
        vmask inside_u = right & (column > vint(0));
        vmask inside_v = up & (row > vint(0));
        auto off_mean = [&](sint step, const vmask& inside) {
            vvec off;
            for (int k = 0; k < 3; ++k) {
                pointer<float> at = normals + b.stride * k;
                vfloat before = gather(at + -step, vertex, inside);
                vfloat here = gather(at, vertex, inside);
                vfloat next = gather(at + step, vertex, inside);
                (k == 0 ? off.x : k == 1 ? off.y : off.z) = fma(before + next, vfloat(-0.5F), here);
            }
            return select(inside, dot(off, off), zero);
        };
        turns = max(off_mean(1, inside_u), turns);
        turns = max(off_mean(width, inside_v), turns);
        turns = max(off_mean(width + 1, inside_u & inside_v), turns);
    }
    Turning t{sfloat(0.0F), sfloat(most_turn)};
    if (branch(min(b.quads_u, b.quads_v) >= least_measured))
        t.turn = sqrt(reduce_max(turns)) * turn_slack;
    if (branch(displacing.any)) {
        sfloat du = reduce_max(along_u[0]);
        du = (reduce_max(along_v[0]) + du) * texcoord_slack;
        sfloat dv = reduce_max(along_u[1]);
        dv = (reduce_max(along_v[1]) + dv) * texcoord_slack;
        t.height = height_change(displacing, du, dv, reduce_max(reach));
    }
    return t;
}

/// A length in the mesh's coordinates, of any direction, along each axis of the instance's.
inline svec placed_length(const Place& place, sfloat mesh_length) {
    svec along{mesh_length, mesh_length, mesh_length};
    if (branch(place.moved)) {
        along.x = length(place.row[0]) * mesh_length;
        along.y = length(place.row[1]) * mesh_length;
        along.z = length(place.row[2]) * mesh_length;
    }
    return along;
}

inline Box grown(const Box& box, const svec& by) {
    return {box.low - by, box.high + by};
}

/// The box of lanes of x[stride], y, z that `which` chooses by column and row.
template <class Which> inline Box box_of_vertices(const Block& b, pointer<float> x, Which which) {
    vfloat big(3.0e38F);
    vvec low{big, big, big};
    vvec high{-big, -big, -big};
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vint column, row;
        vertex_place(b.quads_u, lane_index() + vint(from), column, row);
        vmask here = m & which(column, row);
        pointer<float> at = x + from;
        vvec p;
        p.x = load_vector(at, m);
        p.y = load_vector(at + b.stride, m);
        p.z = load_vector(at + b.stride * 2, m);
        vvec lower = select(here, p, vvec{big, big, big});
        low = {min(lower.x, low.x), min(lower.y, low.y), min(lower.z, low.z)};
        vvec upper = select(here, p, vvec{-big, -big, -big});
        high = {max(upper.x, high.x), max(upper.y, high.y), max(upper.z, high.z)};
    }
    Box box;
    box.low = {reduce_min(low.x), reduce_min(low.y), reduce_min(low.z)};
    box.high = {reduce_max(high.x), reduce_max(high.y), reduce_max(high.z)};
    return box;
}

/// Sides of the patch that hang have finer vertices beside those of the block's own sides: on the surface
/// there, displaced in whatever way.
inline Box hold_hanging_sides(const Context& c, const Block& b, const svec& wide, Box box) {
    pointer<float> surface = displaced_array(c, b, displaced_surface);
    for (int s = 0; s < 4; ++s) {
        sint hang = load(field(b.header, &BlockHeader::hang) + s); // 0 if the side is inside the patch
        if (branch(hang > 0)) {
            Box side = box_of_vertices(b, surface, [&](const vint& column, const vint& row) {
                return s == 0   ? row == vint(0)
                       : s == 1 ? column == vint(b.quads_u)
                       : s == 2 ? row == vint(b.quads_v)
                                : column == vint(0);
            });
            box = hold(box, grown(side, wide));
        }
    }
    return box;
}

/// By how much own vertices differ from where the block has them now, along any axis.
inline sfloat moved_by_sides(const Context& c, const Block& b) {
    pointer<float> own = displaced_array(c, b, displaced_normal);
    vfloat most(0.0F);
    sint values = b.stride * 3;
    for (sint from = 0; branch(from < values); from += isa::width) {
        vmask m = first_lanes(values - from);
        vfloat before = load_vector(own + from, m);
        vfloat now = load_vector(b.x + from, m);
        most = max(select(m, abs(now - before), vfloat(0.0F)), most);
    }
    return reduce_max(most);
}

inline void copy_vertices(const Block& b, pointer<float> to) {
    sint values = b.stride * 3;
    for (sint from = 0; branch(from < values); from += isa::width) {
        vmask m = first_lanes(values - from);
        vfloat v = load_vector(b.x + from, m);
        store_vector(to + from, v, m);
    }
}

/// Where a displaced block keeps how far finer vertices lie from its own, along any axis.
inline pointer<float> kept_deviation(pointer<BlockHeader> block) {
    sint normals_at = load(field(block, &BlockHeader::normals_at));
    return as<float>(block) + (normals_at - 1);
}

inline sfloat rounding_in(const Box& box) {
    svec low{abs(box.low.x), abs(box.low.y), abs(box.low.z)};
    svec high{abs(box.high.x), abs(box.high.y), abs(box.high.z)};
    sfloat size = largest(low);
    return max(largest(high), size) * few_roundings;
}

/// The vertices of a block, its sides where their owners have them. If there are finer ones, how far they can
/// be is kept, and if `bounded` the block's box is made to hold them.
[[gnu::noinline]] inline void place_displaced(const Context& c, const Cage& g, const Dicing& d,
                                              const Block& b, sbool bounded) {
    Displacing displacing = displacing_of(c, g, d.face);
    svec surface{sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
    sbool finer = d.level > 0;
    sbool measured = max(d.nu, d.nv) >= block_log2;
    sbool small = finer & bounded;
    small = small & !measured;
    svec most = placed_length(g.place, g.displacement * 1.0001F);
    if (branch(small)) {
        bound_by_next_level(c, g, d, b);
    } else if (branch(finer)) {
        surface = summed_deviation(c, g, d, b.column, b.row);
    }
    weigh_displaced(c, g, d, displacing, b);
    Turning own{sfloat(0.0F), sfloat(0.0F)};
    pointer<float> sides = c.stack + scratch_sides;
    if (branch(finer)) {
        own = turning_of(c, displacing, b);
        for (int k = 0; k < side_bounds; ++k)
            store(sides + k, 0.0F);
        copy_vertices(b, displaced_array(c, b, displaced_normal));
    }
    place_sides<false>(c, g, d, b);
    if (branch(!finer))
        return;
    auto all = [](const vint& column, const vint&) { return column >= vint(0); };
    Box box = box_of_vertices(b, b.x, all);
    box = hold(box, box_of_vertices(b, displaced_array(c, b, displaced_normal), all));
    sfloat rounding = rounding_in(box);
    if (branch(small)) {
        svec wide{most.x + rounding, most.y + rounding, most.z + rounding};
        box = hold(box, grown(box_of(b.header), wide));
        store(field(b.header, &BlockHeader::deviation), largest(wide));
    }
    sfloat height = max(load(sides + side_height), own.height);
    sfloat turn = max(load(sides + side_turn), own.turn);
    sfloat seam = load(sides + side_seam);
    svec change = placed_length(g.place, fma(g.displacement, turn, height) * 1.0001F);
    svec deviation = surface + change;
    sfloat more = seam + rounding;
    deviation = {deviation.x + more, deviation.y + more, deviation.z + more};
    sint hangs = load(field(b.header, &BlockHeader::hangs));
    sfloat moved_by = moved_by_sides(c, b);
    sfloat kept = largest(deviation) + moved_by;
    store(kept_deviation(b.header), kept);
    if (branch(!bounded))
        return;
    if (branch(measured)) {
        box = grown(box, deviation);
        if (branch(hangs != 0)) {
            svec wide = surface + most;
            wide = {wide.x + rounding, wide.y + rounding, wide.z + rounding};
            box = hold_hanging_sides(c, b, wide, box);
        }
        store(field(b.header, &BlockHeader::deviation), largest(deviation));
    }
    store_box(b.header, box);
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
