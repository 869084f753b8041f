// Points of displaced surfaces that faces share: the surface's point moved along its normal by a height, all
// three as the point's owner has them, whoever asks (design: shared points have one owner). Displacement
// comes before the instance's place: what scales, shears or mirrors an instance does so to the displaced
// mesh.
#pragma once

#include "razor/kernels/heights.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

struct Displaced {
    vvec point, normal; // mesh coordinates
};
/// Along the normal: where there is none, as in a face without area, points stay.
inline Displaced displaced(const Displacing& d, const vvec& p, const vvec& du, const vvec& dv,
                           const vpoint& uv, const vmask& m) {
    vfloat zero(0.0F);
    Displaced q;
    q.normal = normalise(cross(du, dv), {zero, zero, zero});
    q.point = p;
    if (branch(d.any))
        q.point = madd(height_at(d, uv, m), q.normal, p);
    return q;
}

inline sint texture_shift(const Context& c, const Cage& g) {
    return load(field(c.instances + g.instance, &InstanceRecord::texture_faces));
}

/// Texture coordinates at a face's corner, or at its centre (corner = corner_count).
inline spoint vertex_texcoord(const Context& c, const Cage& g, sint number, sint corner) {
    TextureFace face = texture_face(g, number, texture_shift(c, g));
    sint face_class = load(field(face.record, &FaceRecord::face_class));
    if (branch(face_class >= 0)) {
        sint controls = load(field(face.record, &FaceRecord::control_count));
        pointer<float> row = page_weights(c, g, face_class, PageKind::vertex, corner);
        svec p = weigh_row(g, row, face.first, controls);
        return {p.x, p.y};
    }
    if (branch(corner == face.corners))
        return mean_texcoord(g, face);
    return corner_texcoord(g, face, corner);
}

/// See limit_point().
[[gnu::noinline]] inline svec displaced_point(const Context& c, const Cage& g, sint number, sint corner) {
    pointer<FaceRecord> face = g.faces + number;
    sint face_class = load(field(face, &FaceRecord::face_class));
    sint first = load(field(face, &FaceRecord::control_first));
    sint n = load(field(face, &FaceRecord::control_count));
    pointer<float> row = page_weights(c, g, face_class, PageKind::vertex, corner);
    sint rows = (n + 63) & -64;
    svec p = weigh_row(g, row, first, n);
    svec du = weigh_row(g, row + rows, first, n);
    svec dv = weigh_row(g, row + rows * 2, first, n);
    spoint uv = vertex_texcoord(c, g, number, corner);
    Displacing d = displacing_of(c, g, number);
    vpoint at{vfloat(uv.u), vfloat(uv.v)};
    vvec there = broadcast(p);
    vvec along_u = broadcast(du);
    vvec along_v = broadcast(dv);
    vmask one = first_lanes(1);
    Displaced q = displaced(d, there, along_u, along_v, at, one);
    svec moved_to;
    moved_to.x = extract(q.point.x, 0);
    moved_to.y = extract(q.point.y, 0);
    moved_to.z = extract(q.point.z, 0);
    return moved(g.place, moved_to);
}

/// Linear between two corners (or a middle and the centre) of the texture face, at parameters of a curve.
inline vpoint between_texcoords(const spoint& a, const spoint& b, const vfloat& t) {
    vfloat rest = vfloat(1.0F) - t;
    vfloat u = vfloat(a.u) * rest;
    vfloat v = vfloat(a.v) * rest;
    return {fma(t, vfloat(b.u), u), fma(t, vfloat(b.v), v)};
}

/// Texture coordinates, as the owner has them, of lanes `from` ... of a chunk.
inline vpoint chunk_texcoords(const Context& c, const Cage& g, sint owner, sint local, sint flags,
                              sint exponent, sint chunk, int from, const vmask& m) {
    TextureFace face = texture_face(g, owner, texture_shift(c, g));
    sint face_class = load(field(face.record, &FaceRecord::face_class));
    if (branch(face_class >= 0)) {
        sint index = curve_page_index(g, face_class, local, flags, exponent, chunk);
        pointer<float> weights = page_weights(c, g, face_class, PageKind::curve, index);
        sint controls = load(field(face.record, &FaceRecord::control_count));
        vpoint sum{vfloat(0.0F), vfloat(0.0F)};
        for (sint i = 0; branch(i < controls); ++i) {
            sint point = load(g.controls + (face.first + i));
            vfloat w = load_vector(weights + i * curve_row + from, m);
            sum.u = fma(w, load_broadcast(g.points + point * 3), sum.u);
            sum.v = fma(w, load_broadcast(g.points + (point * 3 + 1)), sum.v);
        }
        return sum;
    }
    spoint a;
    spoint b;
    if (branch(local >= face.corners)) { // a spoke
        spoint corner = corner_texcoord(g, face, local - face.corners);
        a = middle(corner, corner_texcoord(g, face, local - face.corners + 1));
        b = mean_texcoord(g, face);
    } else {
        sbool turned = (flags & curve_owner_reversed) != 0;
        sint begin = select(turned, local + 1, local);
        sint end = select(turned, local, local + 1);
        a = corner_texcoord(g, face, begin);
        b = corner_texcoord(g, face, end);
    }
    vint i = lane_index() + vint(chunk * block_quads + from);
    sfloat step = as_float((sint(127) - exponent) << 23);
    vfloat t = to_float(i);
    t = t * vfloat(step);
    return between_texcoords(a, b, t);
}

inline void store_most(pointer<float> most, sfloat value) {
    sfloat before = load(most);
    store(most, max(before, value));
}

/// How far the curve's points between those of a chunk can be from where these are: what heights differ by,
/// and how far normals are from the means of their neighbours.
inline void bound_chunk(const Context& c, const Displacing& d, sint segments) {
    pointer<float> normals = c.stack + scratch_chunk;
    pointer<float> uv = normals + 3 * curve_row;
    vfloat zero(0.0F);
    vfloat steps[2] = {zero, zero};
    vfloat reach = zero;
    vfloat turns = zero;
    for (int lanes = 0; lanes < curve_row; lanes += isa::width) {
        vint i = lane_index() + vint(lanes);
        vmask m = i < vint(segments);
        for (int k = 0; k < 2; ++k) {
            pointer<float> at = uv + k * curve_row;
            vfloat here = gather(at, i, m);
            vfloat next = gather(at + 1, i, m);
            steps[k] = max(select(m, abs(next - here), zero), steps[k]);
            vfloat largest = max(abs(here), reach);
            largest = max(abs(next), largest);
            reach = select(m, largest, reach);
        }
        vmask inside = m & (i > vint(0));
        vvec off;
        for (int k = 0; k < 3; ++k) {
            pointer<float> at = normals + k * curve_row;
            vfloat before = gather(at + -1, i, inside);
            vfloat here = gather(at, i, inside);
            vfloat next = gather(at + 1, i, inside);
            (k == 0 ? off.x : k == 1 ? off.y : off.z) = fma(before + next, vfloat(-0.5F), here);
        }
        turns = max(select(inside, dot(off, off), zero), turns);
    }
    pointer<float> bounds = c.stack + scratch_sides;
    if (branch(d.any)) {
        sfloat du = reduce_max(steps[0]) * texcoord_slack;
        sfloat dv = reduce_max(steps[1]) * texcoord_slack;
        store_most(bounds + side_height, height_change(d, du, dv, reduce_max(reach)));
    }
    sfloat turn = sqrt(reduce_max(turns)) * turn_slack;
    store_most(bounds + side_turn, select(segments < least_measured, sfloat(most_turn), turn));
}

/// See evaluate_chunk(). All nine points as the curve's owner has them, ends included, which are others' if
/// these are corners.
[[gnu::noinline]] inline void displace_chunk(const Context& c, const Cage& g, pointer<CurveRecord> curve,
                                             sint exponent, sint chunk, pointer<float> points) {
    sint owner = load(field(curve, &CurveRecord::owner_face));
    sint local = load(field(curve, &CurveRecord::owner_local));
    sint flags = load(field(curve, &CurveRecord::flags));
    pointer<FaceRecord> face = g.faces + owner;
    sint face_class = load(field(face, &FaceRecord::face_class));
    sint first = load(field(face, &FaceRecord::control_first));
    sint n = load(field(face, &FaceRecord::control_count));
    sint index = curve_page_index(g, face_class, local, flags, exponent, chunk);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::curve, index);
    pointer<float> derivatives = weights + n * curve_row;
    Displacing d = displacing_of(c, g, owner);
    pointer<float> normals = c.stack + scratch_chunk;
    for (int lanes = 0; lanes < curve_row; lanes += isa::width) {
        vmask m = first_lanes(curve_row - lanes);
        vfloat zero(0.0F);
        vvec p{zero, zero, zero};
        vvec du = p;
        vvec dv = p;
        for (sint i = 0; branch(i < n); ++i) {
            sint point = load(g.controls + (first + i));
            vvec at = load_broadcast_vec(g.points + point * 3);
            vfloat w = load_vector(weights + i * curve_row + lanes, m);
            p = madd(w, at, p);
            pointer<float> rows = derivatives + i * (2 * curve_row) + lanes;
            vfloat wu = load_vector(rows, m);
            du = madd(wu, at, du);
            vfloat wv = load_vector(rows + curve_row, m);
            dv = madd(wv, at, dv);
        }
        vpoint uv = chunk_texcoords(c, g, owner, local, flags, exponent, chunk, lanes, m);
        Displaced q = displaced(d, p, du, dv, uv, m);
        pointer<float> to = normals + lanes;
        store_vector(to, q.normal.x, m);
        store_vector(to + curve_row, q.normal.y, m);
        store_vector(to + 2 * curve_row, q.normal.z, m);
        store_vector(to + 3 * curve_row, uv.u, m);
        store_vector(to + 4 * curve_row, uv.v, m);
        if (branch(g.place.moved))
            q.point = moved_points(g.place, q.point);
        to = points + lanes;
        store_vector(to, q.point.x, m);
        store_vector(to + curve_row, q.point.y, m);
        store_vector(to + 2 * curve_row, q.point.z, m);
    }
    bound_chunk(c, d, min(sint(1) << exponent, block_quads));
}

/// Puts an end of a curve where its owner has it, and notes how far that is from where the curve's owner has
/// it.
[[gnu::noinline]] inline void note_end(const Context& c, pointer<float> points, sint lane, const svec& p) {
    svec off = get_point(points, lane) - p;
    sfloat y = abs(off.y);
    sfloat z = abs(off.z);
    z = max(y, z);
    store_most(c.stack + (scratch_sides + side_seam), max(abs(off.x), z));
}
template <bool Straight>
inline void put_end(const Context& c, const Cage& g, sint exponent, pointer<float> points, sint lane,
                    const svec& p) {
    if constexpr (!Straight) {
        if (branch(g.displaced & (exponent > 0)))
            note_end(c, points, lane, p);
    }
    put_point(points, lane, p);
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
