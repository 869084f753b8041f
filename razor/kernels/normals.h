// Shading normals of a block's vertices, made when the first camera ray is shaded there: limit normals from
// derivative pages, or those of the bilinear patch. Flat patches have none, unless they have texture
// coordinates or are asked where they are at rest: their triangles' normals serve.
#pragma once

#include "razor/kernels/chords.h"
#include "razor/kernels/displaced_normals.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Sums derivative rows for a vector of vertices from `from` on.
inline void weigh_derivatives(const Cage& g, pointer<float> weights, sint row_stride, sint controls_first,
                              sint controls, sint from, const vmask& m, vvec& du, vvec& dv) {
    vfloat zero(0.0F);
    du = {zero, zero, zero};
    dv = {zero, zero, zero};
    pointer<float> row = weights + from;
    for (sint i = 0; branch(i < controls); ++i) {
        sint point = load(g.controls + (controls_first + i));
        vvec p = load_broadcast_vec(g.points + point * 3);
        vfloat wu = load_vector(row, m);
        du = madd(wu, p, du);
        vfloat wv = load_vector(row + row_stride, m);
        dv = madd(wv, p, dv);
        row = row + row_stride * 2;
    }
    if (branch(g.place.moved)) {
        du = moved_directions(g.place, du);
        dv = moved_directions(g.place, dv);
    }
}

/// The arrays of where a block's vertices are while its mesh is at rest, `normals` being its own.
inline pointer<float> rest_at(pointer<float> normals, sint stride, sint shading) {
    sint before = texcoord_arrays(shading) + 3;
    return normals + before * stride;
}

/// Makes them: x[stride], y[stride], z[stride].
inline void make_rest(const Context& c, const Cage& g, const Dicing& d, const Block& b, pointer<float> out) {
    Cage rest = g;
    rest.points = load(field(c.frame, &FrameHeader::rest_points));
    rest.place.moved = false;
    Block to = b;
    to.x = out;
    if (branch(d.kind == static_cast<int>(PatchKind::catmull_clark))) {
        sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
        sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
        sint controls = load(field(g.faces + d.face, &FaceRecord::control_count));
        sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
        pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
        weigh_all(rest, weights, page_stride(b.stride), first, controls, b.stride, out, b.stride);
    } else if (branch(is_flat(d))) {
        place_flat(rest, d, to);
    } else {
        place_bilinear(c, rest, d, to);
    }
}

[[gnu::noinline]] inline void make_normals(const Context& c, sint line, pointer<BlockHeader> header,
                                           sint normals_at) {
    phase_scope phase(phase_shade);
    tally(c.counters->normal_blocks, 1);
    sint patch = load(field(header, &BlockHeader::patch));
    sint instance = load(field(header, &BlockHeader::instance));
    sint level = load(field(header, &BlockHeader::level));
    Cage g = load_cage(c, instance, level);
    Dicing d = plan_dicing(c, g, instance, patch, level);
    Block b;
    b.row = load(field(header, &BlockHeader::row));
    b.column = load(field(header, &BlockHeader::column));
    b.quads_u = load(field(header, &BlockHeader::quads_u));
    b.stride = load(field(header, &BlockHeader::stride));
    measure_chords(c, header, normals_at, is_flat(d));
    pointer<float> out = as<float>(c.grids + line) + normals_at;
    if (branch(texcoord_arrays(d.shading) != 0)) {
        sint shift = load(field(c.instances + instance, &InstanceRecord::texture_faces));
        make_texcoords(c, g, d, b, shift, out + b.stride * 3);
    }
    if (branch(rest_arrays(d.shading) != 0))
        make_rest(c, g, d, b, rest_at(out, b.stride, d.shading));
    if (branch(g.displaced)) {
        make_displaced_normals(c, g, d, b, out);
        return;
    }
    if (branch(d.kind == static_cast<int>(PatchKind::catmull_clark))) {
        sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
        sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
        sint controls = load(field(g.faces + d.face, &FaceRecord::control_count));
        sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
        pointer<float> weights = page_weights(c, g, face_class, PageKind::derivative, index);
        sint row_stride = page_stride(b.stride);
        for (sint from = 0; branch(from < b.stride); from += isa::width) {
            vmask m = first_lanes(b.stride - from);
            vvec du, dv;
            weigh_derivatives(g, weights, row_stride, first, controls, from, m, du, dv);
            store_normals(out + from, b.stride, du, dv, m);
        }
        return;
    }
    vvec corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = broadcast(straight_corner(c, g, d, k));
    sfloat step_u = as_float((sint(127) - d.nu) << 23);
    sfloat step_v = as_float((sint(127) - d.nv) << 23);
    sint column0 = b.column * block_quads;
    sint row0 = b.row * block_quads;
    vvec bottom = corner[1] - corner[0];
    vvec top = corner[2] - corner[3];
    vvec left = corner[3] - corner[0];
    vvec right = corner[2] - corner[1];
    vvec top_more = top - bottom;
    vvec right_more = right - left;
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vint vertex = lane_index() + vint(from);
        vint column, row;
        vertex_place(b.quads_u, vertex, column, row);
        column = column + vint(column0);
        row = row + vint(row0);
        vfloat u = to_float(column);
        u = u * vfloat(step_u);
        vfloat v = to_float(row);
        v = v * vfloat(step_v);
        vvec du = madd(v, top_more, bottom);
        vvec dv = madd(u, right_more, left);
        store_normals(out + from, b.stride, du, dv, m);
    }
}

/// Returns once the block's normals are there. 0: it has none.
inline sint ensure_normals(const Context& c, sint line) {
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + line);
    sint normals_at = load(field(header, &BlockHeader::normals_at));
    if (branch(normals_at != 0))
        build_once(c, field(header, &BlockHeader::normals),
                   [&] { make_normals(c, line, header, normals_at); });
    return normals_at;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
