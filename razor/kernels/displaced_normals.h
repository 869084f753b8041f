// Normals of displaced surfaces: of P = S + h N the cross product of P_u = S_u + h_u N + h N_u and P_v. How
// the surface's own normal N turns is known exactly, from second derivatives; heights are compared half a
// step of the finest grid to either side, since the heights between its vertices are no surface's. So a
// vertex has one normal, whatever block or level it is seen in, that of its face.
#pragma once

#include "razor/kernels/tessellate.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

inline void store_normals(pointer<float> out, sint stride, const vvec& du, const vvec& dv, const vmask& m) {
    vfloat zero(0.0F);
    vvec n = normalise(cross(du, dv), {zero, zero, zero});
    store_vector(out, n.x, m);
    store_vector(out + stride, n.y, m);
    store_vector(out + stride * 2, n.z, m);
}

/// How texture coordinates change along a patch's u and v.
struct TexcoordSlopes {
    vpoint along_u, along_v;
};

/// Of a smooth texture face, by its own derivatives.
inline TexcoordSlopes weigh_texcoord_slopes(const Context& c, const Cage& g, const Dicing& d, const Block& b,
                                            const TextureFace& face, sint face_class, sint from,
                                            const vmask& m) {
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
    pointer<float> row = page_weights(c, g, face_class, PageKind::derivative, index) + from;
    sint row_stride = page_stride(b.stride);
    sint controls = load(field(face.record, &FaceRecord::control_count));
    vfloat zero(0.0F);
    TexcoordSlopes s{{zero, zero}, {zero, zero}};
    for (sint i = 0; branch(i < controls); ++i) {
        sint point = load(g.controls + (face.first + i));
        vfloat u = load_broadcast(g.points + point * 3);
        vfloat v = load_broadcast(g.points + (point * 3 + 1));
        vfloat w = load_vector(row, m);
        s.along_u.u = fma(w, u, s.along_u.u);
        s.along_u.v = fma(w, v, s.along_u.v);
        w = load_vector(row + row_stride, m);
        s.along_v.u = fma(w, u, s.along_v.u);
        s.along_v.v = fma(w, v, s.along_v.v);
        row = row + row_stride * 2;
    }
    return s;
}

/// Of one that is linear: between the differences of its corners.
inline TexcoordSlopes linear_texcoord_slopes(const Cage& g, const Dicing& d, const TextureFace& face,
                                             const vfloat& u, const vfloat& v) {
    spoint corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = patch_texcoord(g, d, face, k);
    vfloat u0 = vfloat(1.0F) - u;
    vfloat v0 = vfloat(1.0F) - v;
    TexcoordSlopes s;
    auto slope = [&](int from, int to, int from_across, int to_across, const vfloat& t, const vfloat& rest) {
        sfloat here_u = corner[to].u - corner[from].u;
        sfloat across_u = corner[to_across].u - corner[from_across].u;
        sfloat here_v = corner[to].v - corner[from].v;
        sfloat across_v = corner[to_across].v - corner[from_across].v;
        vpoint p;
        p.u = between(here_u, across_u, t, rest);
        p.v = between(here_v, across_v, t, rest);
        return p;
    };
    s.along_u = slope(0, 1, 3, 2, v, v0);
    s.along_v = slope(0, 3, 1, 2, u, u0);
    return s;
}

/// What heights differ by over a step of a patch's parameter about each place.
inline vfloat height_step(const Displacing& displacing, const vpoint& uv, const vpoint& slope, sfloat step,
                          const vmask& m) {
    vfloat half(step * 0.5F);
    vpoint before{fnma(half, slope.u, uv.u), fnma(half, slope.v, uv.v)};
    vpoint after{fma(half, slope.u, uv.u), fma(half, slope.v, uv.v)};
    vfloat low = height_at(displacing, before, m);
    vfloat high = height_at(displacing, after, m);
    return high - low;
}

/// The derivatives of a limit surface.
struct Curving {
    vvec u, v, uu, uv, vv;
};
inline Curving curving_of(const Cage& g, pointer<float> weights, sint row_stride, sint first, sint controls,
                          sint from, const vmask& m) {
    vfloat zero(0.0F);
    vvec none{zero, zero, zero};
    Curving s{none, none, none, none, none};
    pointer<float> row = weights + from;
    pointer<float> second = row + row_stride * (controls * 2);
    for (sint i = 0; branch(i < controls); ++i) {
        sint point = load(g.controls + (first + i));
        vvec p = load_broadcast_vec(g.points + point * 3);
        vfloat w = load_vector(row, m);
        s.u = madd(w, p, s.u);
        w = load_vector(row + row_stride, m);
        s.v = madd(w, p, s.v);
        w = load_vector(second, m);
        s.uu = madd(w, p, s.uu);
        w = load_vector(second + row_stride, m);
        s.uv = madd(w, p, s.uv);
        w = load_vector(second + row_stride * 2, m);
        s.vv = madd(w, p, s.vv);
        row = row + row_stride * 2;
        second = second + row_stride * 3;
    }
    return s;
}

/// How the unit normal turns where the normal, of that length's reciprocal, turns like this.
inline vvec turn_of(const vvec& normal, const vfloat& per_length, const vvec& turns) {
    vvec turn = turns * per_length;
    return turn - normal * dot(normal, turn);
}

[[gnu::noinline]] inline void make_displaced_normals(const Context& c, const Cage& g, const Dicing& d,
                                                     const Block& b, pointer<float> out) {
    Displacing displacing = displacing_of(c, g, d.face);
    sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
    sint first = load(field(g.faces + d.face, &FaceRecord::control_first));
    sint controls = load(field(g.faces + d.face, &FaceRecord::control_count));
    sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::derivative, index);
    sint row_stride = page_stride(b.stride);
    sint shift = texture_shift(c, g);
    pointer<float> coordinates = displaced_array(c, b, displaced_texcoord);
    make_texcoords(c, g, d, b, shift, coordinates);
    TextureFace face = texture_face(g, d.face, shift);
    sint texture_class = load(field(face.record, &FaceRecord::face_class));
    // Steps of a block's grid, and of the finest.
    sfloat step_u = as_float((sint(127) - d.nu) << 23);
    sfloat step_v = as_float((sint(127) - d.nv) << 23);
    sfloat finest_u = as_float((sint(127) - (d.nu + d.level)) << 23);
    sfloat finest_v = as_float((sint(127) - (d.nv + d.level)) << 23);
    for (sint from = 0; branch(from < b.stride); from += isa::width) {
        vmask m = first_lanes(b.stride - from);
        Curving s = curving_of(g, weights, row_stride, first, controls, from, m);
        vpoint uv;
        uv.u = load_vector(coordinates + from, m);
        uv.v = load_vector(coordinates + b.stride + from, m);
        TexcoordSlopes slopes;
        if (branch(texture_class >= 0)) {
            slopes = weigh_texcoord_slopes(c, g, d, b, face, texture_class, from, m);
        } else {
            vint column, row;
            vertex_place(b.quads_u, lane_index() + vint(from), column, row);
            column = column + vint(b.column * block_quads);
            row = row + vint(b.row * block_quads);
            vfloat u = to_float(column);
            u = u * vfloat(step_u);
            vfloat v = to_float(row);
            v = v * vfloat(step_v);
            slopes = linear_texcoord_slopes(g, d, face, u, v);
        }
        vvec du = s.u;
        vvec dv = s.v;
        if (branch(displacing.any)) {
            vvec area = cross(s.u, s.v);
            vfloat square = dot(area, area);
            vmask good = square > vfloat(0.0F);
            vfloat per_length = reciprocal_sqrt(select(good, square, vfloat(1.0F)));
            vvec normal = area * per_length;
            vfloat height = height_at(displacing, uv, m);
            vvec along_u = cross(s.uu, s.v);
            along_u = along_u + cross(s.u, s.uv);
            vvec along_v = cross(s.uv, s.v);
            along_v = along_v + cross(s.u, s.vv);
            vfloat rise_u = height_step(displacing, uv, slopes.along_u, finest_u, m);
            rise_u = rise_u * reciprocal(vfloat(finest_u));
            vfloat rise_v = height_step(displacing, uv, slopes.along_v, finest_v, m);
            rise_v = rise_v * reciprocal(vfloat(finest_v));
            du = madd(height, turn_of(normal, per_length, along_u), du);
            du = madd(rise_u, normal, du);
            dv = madd(height, turn_of(normal, per_length, along_v), dv);
            dv = madd(rise_v, normal, dv);
            // Where the surface has no normal, or none is known, its own has to do.
            vvec bent = cross(du, dv);
            vfloat bent_square = dot(bent, bent);
            good = good & (bent_square > vfloat(0.0F));
            good = good & (bent_square < vfloat(3.0e38F));
            du = select(good, du, s.u);
            dv = select(good, dv, s.v);
        }
        if (branch(g.place.moved)) {
            du = moved_directions(g.place, du);
            dv = moved_directions(g.place, dv);
        }
        store_normals(out + from, b.stride, du, dv, m);
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
