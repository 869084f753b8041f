// Texture coordinates of a block's vertices, made with their normals and from the same parameters: by the
// weights of the face's texture cage (razor/surface/texture_cage.h), or bilinear in its corners.
#pragma once

#include "razor/kernels/dicing.h"
#include "razor/kernels/texture_face.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Which corner of its face a flat triangle's corner is.
inline sint local_corner(const Cage& g, const Dicing& d, sint point) {
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint n = load(field(g.faces + d.face, &FaceRecord::control_count));
    sint found = 0;
    for (sint i = 0; branch(i < n); ++i) {
        sint other = load(g.controls + (first + i));
        found = select(other == point, i, found);
    }
    return found;
}

/// Of a patch whose texture coordinates are linear.
inline spoint patch_texcoord(const Cage& g, const Dicing& d, const TextureFace& face, int k) {
    if (branch(d.kind == static_cast<int>(PatchKind::flat_triangle))) {
        sint point = load(field(d.record, &PatchRecord::corner) + k);
        return corner_texcoord(g, face, local_corner(g, d, point));
    }
    if (branch(half(d.side[0]) == 0)) // a whole quad
        return corner_texcoord(g, face, sint(k));
    spoint own = corner_texcoord(g, face, d.sub);
    if (k == 0)
        return own;
    if (k == 1)
        return middle(own, corner_texcoord(g, face, d.sub + 1));
    if (k == 3)
        return middle(own, corner_texcoord(g, face, d.sub + (face.corners - 1)));
    return mean_texcoord(g, face);
}

/// `out`: u[stride], v[stride].
inline void weigh_texcoords(const Context& c, const Cage& g, const Dicing& d, const Block& b,
                            const TextureFace& face, pointer<float> out) {
    sint face_class = load(field(face.record, &FaceRecord::face_class));
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
    sint row_stride = page_stride(b.stride);
    sint controls = load(field(face.record, &FaceRecord::control_count));
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vfloat u(0.0F);
        vfloat v(0.0F);
        pointer<float> row = weights + from;
        for (sint i = 0; branch(i < controls); ++i) {
            sint point = load(g.controls + (face.first + i));
            vfloat w = load_vector(row, m);
            u = fma(w, load_broadcast(g.points + point * 3), u);
            v = fma(w, load_broadcast(g.points + (point * 3 + 1)), v);
            row = row + row_stride;
        }
        store_vector(out + from, u, m);
        store_vector(out + b.stride + from, v, m);
    }
}

/// `rest`: 1 - t.
inline vfloat between(const sfloat& a, const sfloat& b, const vfloat& t, const vfloat& rest) {
    vfloat part = vfloat(a) * rest;
    return fma(t, vfloat(b), part);
}

inline void interpolate_texcoords(const Cage& g, const Dicing& d, const Block& b, const TextureFace& face,
                                  pointer<float> out) {
    spoint corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = patch_texcoord(g, d, face, k);
    sfloat step_u = as_float((sint(127) - d.nu) << 23);
    sfloat step_v = as_float((sint(127) - d.nv) << 23);
    sint column0 = b.column * block_quads;
    sint row0 = b.row * block_quads;
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        vint vertex = lane_index() + vint(from);
        vint column, row;
        vertex_place(b.quads_u, vertex, column, row);
        column = column + vint(column0);
        row = row + vint(row0);
        vfloat s = to_float(column);
        s = s * vfloat(step_u);
        vfloat t = to_float(row);
        t = t * vfloat(step_v);
        vfloat s0 = vfloat(1.0F) - s;
        vfloat t0 = vfloat(1.0F) - t;
        vfloat low = between(corner[0].u, corner[1].u, s, s0);
        vfloat high = between(corner[3].u, corner[2].u, s, s0);
        low = low * t0;
        vfloat value = fma(t, high, low);
        store_vector(out + from, value, m);
        low = between(corner[0].v, corner[1].v, s, s0);
        high = between(corner[3].v, corner[2].v, s, s0);
        low = low * t0;
        pointer<float> second = out + b.stride;
        value = fma(t, high, low);
        store_vector(second + from, value, m);
    }
}

/// `shift`: from the mesh's faces to those of its texture cage.
inline void make_texcoords(const Context& c, const Cage& g, const Dicing& d, const Block& b, sint shift,
                           pointer<float> out) {
    TextureFace face = texture_face(g, d.face, shift);
    sint face_class = load(field(face.record, &FaceRecord::face_class));
    if (branch(face_class >= 0)) {
        weigh_texcoords(c, g, d, b, face, out);
    } else {
        interpolate_texcoords(g, d, b, face, out);
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
