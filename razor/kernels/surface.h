// Points of limit surfaces and of straight-edged patches: curve exponents, curve points, corners, centres.
// All are pure functions of their owner, recomputed by whoever needs them, so that neighbours agree bit for
// bit.
#pragma once

#include "razor/kernels/displace.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// Limit position at a face's corner (or its centre: corner = corner_count). One lane a control point.
inline svec limit_point(const Context& c, const Cage& g, sint number, sint corner) {
    if (branch(g.displaced))
        return displaced_point(c, g, number, corner);
    pointer<FaceRecord> face = g.faces + number;
    sint face_class = load(field(face, &FaceRecord::face_class));
    sint first = load(field(face, &FaceRecord::control_first));
    sint n = load(field(face, &FaceRecord::control_count));
    pointer<float> row = page_weights(c, g, face_class, PageKind::vertex, corner);
    svec p = weigh_row(g, row, first, n);
    return moved(g.place, p);
}

/// Where a cage point lies on the surface.
template <bool Straight> inline svec vertex_position(const Context& c, const Cage& g, sint point) {
    if constexpr (Straight)
        return placed_point(g, point);
    sint owner = load(field(g.vertices + point, &VertexRecord::owner_face));
    sint corner = load(field(g.vertices + point, &VertexRecord::owner_corner));
    return limit_point(c, g, owner, corner);
}

template <bool Straight> inline svec face_centre(const Context& c, const Cage& g, sint number) {
    pointer<FaceRecord> face = g.faces + number;
    sint n = load(field(face, &FaceRecord::corner_count));
    if constexpr (!Straight)
        return limit_point(c, g, number, n);
    sint first = load(field(face, &FaceRecord::control_first));
    svec sum{sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
    for (sint i = 0; branch(i < n); ++i) {
        sint point = load(g.controls + (first + i));
        sum = sum + placed_point(g, point);
    }
    return sum * (sfloat(1.0F) / to_float(n));
}

inline svec middle(const svec& a, const svec& b) {
    return (a + b) * 0.5F;
}

/// Writes the interior points of one chunk of a curve of exponent N (points (8 chunk + i) / 2^N, i = 0..8, of
/// which those outside the curve are undefined) to `points`: x[16], y[16], z[16]. Ends are for the caller.
inline void evaluate_chunk(const Context& c, const Cage& g, pointer<CurveRecord> curve, sint exponent,
                           sint chunk, pointer<float> points) {
    sint owner = load(field(curve, &CurveRecord::owner_face));
    sint local = load(field(curve, &CurveRecord::owner_local));
    sint flags = load(field(curve, &CurveRecord::flags));
    pointer<FaceRecord> face = g.faces + owner;
    if (branch(g.displaced)) {
        displace_chunk(c, g, curve, exponent, chunk, points);
        return;
    }
    sint face_class = load(field(face, &FaceRecord::face_class));
    sint first = load(field(face, &FaceRecord::control_first));
    sint n = load(field(face, &FaceRecord::control_count));
    sint index = curve_page_index(g, face_class, local, flags, exponent, chunk);
    pointer<float> weights = page_weights(c, g, face_class, PageKind::curve, index);
    for (int lanes = 0; lanes < curve_row; lanes += isa::width) {
        vmask m = first_lanes(curve_row - lanes);
        vvec sum{vfloat(0.0F), vfloat(0.0F), vfloat(0.0F)};
        for (sint i = 0; branch(i < n); ++i) {
            sint point = load(g.controls + (first + i));
            vvec p = load_broadcast_vec(g.points + point * 3);
            vfloat w = load_vector(weights + i * curve_row + lanes, m);
            sum = madd(w, p, sum);
        }
        if (branch(g.place.moved))
            sum = moved_points(g.place, sum);
        store_vector(points + lanes, sum.x, m);
        store_vector(points + curve_row + lanes, sum.y, m);
        store_vector(points + 2 * curve_row + lanes, sum.z, m);
    }
}

inline sfloat length(const svec& d) {
    return sqrt(fma(d.x, d.x, fma(d.y, d.y, d.z * d.z)));
}

/// How long the curve of a cage edge is, in the mesh's units: the two chords to its middle. By the mesh's
/// cage points alone, so that all its instances at one level are diced alike.
inline sfloat measure_curve(const Context& c, Cage g, pointer<CurveRecord> curve) {
    g.place.moved = false;
    g.displaced = false;
    pointer<float> points = c.stack + (scratch_curve + 2 * scratch_curve_size);
    evaluate_chunk(c, g, curve, 1, 0, points);
    svec middle = get_point(points, 1);
    sint end0 = load(field(curve, &CurveRecord::end0));
    svec to0 = vertex_position<false>(c, g, end0) - middle;
    sint end1 = load(field(curve, &CurveRecord::end1));
    svec to1 = vertex_position<false>(c, g, end1) - middle;
    sfloat first = length(to0);
    return first + length(to1);
}

/// The same, measured once for a tree: whoever comes first. All find the same bits, as points of a curve are
/// its owner's; so nobody waits.
inline sfloat curve_length(const Context& c, const Cage& g, sint number) {
    pointer<shared_int> known = c.curve_lengths + number;
    sint bits = load_acquire(known);
    if (branch(bits == 0)) {
        sfloat length = measure_curve(c, g, g.curves + number);
        bits = as_int(max(length, least_curve_length));
        store_release(known, bits);
    }
    return as_float(bits);
}

/// Exponent N of a cage edge at level 0: 2^N segments of about the target length, N = round(log2(length /
/// target)), in [0, max_exponent]. A limit curve is shorter than its cage edge, often by a third, which
/// counts along both sides. Straight: the edge is the curve.
inline sint edge_exponent(const Context& c, const Cage& g, sint number, sbool straight) {
    sfloat square = 0.0F;
    if (branch(straight)) {
        pointer<CurveRecord> curve = g.curves + number;
        sint end0 = load(field(curve, &CurveRecord::end0));
        sint end1 = load(field(curve, &CurveRecord::end1));
        svec a = cage_point(g, end0);
        svec b = cage_point(g, end1);
        svec d = (b - a) * g.per_edge_length;
        square = fma(d.x, d.x, fma(d.y, d.y, d.z * d.z));
    } else {
        sfloat segments = curve_length(c, g, number) * g.per_edge_length;
        square = segments * segments;
    }
    sfloat doubled = square + square; // floor(log2(2 r^2)) / 2 rounds log2(r) to nearest
    sint exponent = ((as_int(doubled) >> 23) - 127) >> 1;
    return min(max(exponent, 0), g.max_exponent);
}

/// All spokes of an n-gon share one exponent: the largest half edge's.
inline sint spoke_exponent(const Context& c, const Cage& g, pointer<FaceRecord> face, sbool straight) {
    sint corners = load(field(face, &FaceRecord::corner_count));
    sint first = load(field(face, &FaceRecord::curve_first));
    sint largest = 1;
    for (sint i = 0; branch(i < corners); ++i) {
        sint curve = load(g.face_curves + (first + i));
        largest = max(largest, edge_exponent(c, g, curve, straight));
    }
    return largest - 1;
}

inline sint curve_exponent(const Context& c, const Cage& g, sint number, sbool straight) {
    pointer<CurveRecord> curve = g.curves + number;
    sint flags = load(field(curve, &CurveRecord::flags));
    if (branch((flags & curve_spoke) != 0)) {
        sint face = load(field(curve, &CurveRecord::owner_face));
        return spoke_exponent(c, g, g.faces + face, straight);
    }
    return edge_exponent(c, g, number, straight);
}

/// The points of one chunk of a cage edge, with its ends, which belong to the cage points.
template <bool Straight>
inline void edge_points(const Context& c, const Cage& g, pointer<CurveRecord> curve, sint exponent,
                        sint chunk, pointer<float> points) {
    if (branch(exponent > 0))
        evaluate_chunk(c, g, curve, exponent, chunk, points);
    if (branch(chunk == 0)) {
        sint end = load(field(curve, &CurveRecord::end0));
        put_end<Straight>(c, g, exponent, points, 0, vertex_position<Straight>(c, g, end));
    }
    sint last = sint(1) << exponent;
    last = last - chunk * block_quads;
    if (branch(last <= block_quads)) {
        sint end = load(field(curve, &CurveRecord::end1));
        put_end<Straight>(c, g, exponent, points, last, vertex_position<Straight>(c, g, end));
    }
}

/// The middle of a cage edge at the cage's level: one of its points, or (exponent 0) the mean of its ends.
template <bool Straight> inline svec edge_middle(const Context& c, const Cage& g, sint number) {
    pointer<CurveRecord> curve = g.curves + number;
    pointer<float> points = c.stack + (scratch_curve + scratch_curve_size);
    sint exponent = 0;
    if constexpr (!Straight) {
        sint whole = edge_exponent(c, g, number, false);
        exponent = max(whole - g.level, 0);
    }
    sint at = (sint(1) << exponent) >> 1;
    edge_points<Straight>(c, g, curve, exponent, at >> block_log2, points);
    if (branch(exponent == 0)) {
        svec a = get_point(points, 0);
        svec b = get_point(points, 1);
        return middle(a, b);
    }
    return get_point(points, at & (block_quads - 1));
}

/// Points of any curve, ends included, into the first curve scratch. `exponent` is the curve's at the cage's
/// level, 0 if it is straight.
template <bool Straight>
inline pointer<float> curve_points(const Context& c, const Cage& g, pointer<CurveRecord> curve, sint exponent,
                                   sint chunk) {
    pointer<float> points = c.stack + scratch_curve;
    sint flags = load(field(curve, &CurveRecord::flags));
    if (branch((flags & curve_spoke) == 0)) {
        edge_points<Straight>(c, g, curve, exponent, chunk, points);
        return points;
    }
    if (branch(exponent > 0))
        evaluate_chunk(c, g, curve, exponent, chunk, points);
    if (branch(chunk == 0)) {
        sint edge = load(field(curve, &CurveRecord::end0));
        put_end<Straight>(c, g, exponent, points, 0, edge_middle<Straight>(c, g, edge));
    }
    sint last = sint(1) << exponent;
    last = last - chunk * block_quads;
    if (branch(last <= block_quads)) {
        sint face = load(field(curve, &CurveRecord::end1));
        put_end<Straight>(c, g, exponent, points, last, face_centre<Straight>(c, g, face));
    }
    return points;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
