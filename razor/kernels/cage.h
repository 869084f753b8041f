// The cage of a mesh as kernels have it: from its coordinates to those of an instance, and its pages of
// weights.
#pragma once

#include "razor/frame/scratch.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// From a mesh's coordinates to those of an instance. Points are weighted first and moved then, by whoever
/// asks for them, so that shared ones keep equal bits.
struct Place {
    sbool moved; // or the map is the identity
    svec row[3]; // of the linear part
    svec offset;
};

/// The cage of one mesh as an instance has it, as handles in registers.
struct Cage {
    pointer<FaceRecord> faces;
    pointer<VertexRecord> vertices;
    pointer<CurveRecord> curves;
    pointer<std::int32_t> face_curves, controls;
    pointer<float> points;
    pointer<ClassRecord> classes;
    sfloat per_edge_length; // 1 / edge length at level 0, mesh units
    Place place;
    sint max_exponent;
    sint level; // at which points are asked for
    sint instance;
    /// Points on surfaces lie beside them, along their normals, by `displacement` at most: mesh units.
    sbool displaced = false;
    sfloat displacement;
};

inline Place load_place(pointer<InstanceRecord> instance) {
    Place p;
    p.moved = load(field(instance, &InstanceRecord::moved)) != 0;
    if (branch(p.moved)) {
        pointer<float> linear = field(instance, &InstanceRecord::linear);
        for (int k = 0; k < 3; ++k)
            p.row[k] = load_svec(linear + 3 * k);
        p.offset = load_svec(field(instance, &InstanceRecord::offset));
    }
    return p;
}

inline sfloat moved_along(const svec& row, sfloat offset, const svec& p) {
    return fma(row.x, p.x, fma(row.y, p.y, fma(row.z, p.z, offset)));
}
inline svec moved(const Place& place, const svec& p) {
    svec q = p;
    if (branch(place.moved)) {
        q.x = moved_along(place.row[0], place.offset.x, p);
        q.y = moved_along(place.row[1], place.offset.y, p);
        q.z = moved_along(place.row[2], place.offset.z, p);
    }
    return q;
}

/// Of a place that moves.
inline vfloat moved_along(const svec& row, sfloat offset, const vvec& p) {
    vfloat x(row.x);
    vfloat y(row.y);
    vfloat z(row.z);
    vfloat o(offset);
    return fma(x, p.x, fma(y, p.y, fma(z, p.z, o)));
}
inline vvec moved_points(const Place& place, const vvec& p) {
    vvec q;
    q.x = moved_along(place.row[0], place.offset.x, p);
    q.y = moved_along(place.row[1], place.offset.y, p);
    q.z = moved_along(place.row[2], place.offset.z, p);
    return q;
}
inline vvec moved_directions(const Place& place, const vvec& d) {
    vvec q;
    q.x = moved_along(place.row[0], 0.0F, d);
    q.y = moved_along(place.row[1], 0.0F, d);
    q.z = moved_along(place.row[2], 0.0F, d);
    return q;
}

/// Of all meshes: without what an instance makes of one.
inline Cage load_topology(const Context& c) {
    Cage g;
    g.faces = load(field(c.frame, &FrameHeader::faces));
    g.vertices = load(field(c.frame, &FrameHeader::vertices));
    g.curves = load(field(c.frame, &FrameHeader::curves));
    g.face_curves = load(field(c.frame, &FrameHeader::face_curves));
    g.controls = load(field(c.frame, &FrameHeader::controls));
    g.points = load(field(c.frame, &FrameHeader::points));
    g.classes = load(field(c.frame, &FrameHeader::classes));
    return g;
}

inline Cage load_cage(const Context& c, sint instance, sint level) {
    Cage g = load_topology(c);
    pointer<InstanceRecord> record = c.instances + instance;
    sfloat edge = load(field(record, &InstanceRecord::mesh_edge_length));
    g.per_edge_length = sfloat(1.0F) / edge;
    g.max_exponent = load(field(record, &InstanceRecord::max_exponent));
    g.place = load_place(record);
    g.level = level;
    g.instance = instance;
    pointer<float> bounds = load(field(c.frame, &FrameHeader::displacement_bounds));
    if (branch(!is_null(bounds))) {
        g.displacement = load(bounds + instance);
        g.displaced = g.displacement > 0.0F;
    }
    return g;
}

/// In mesh coordinates.
inline svec cage_point(const Cage& g, sint point) {
    return load_svec(g.points + point * 3);
}
inline svec placed_point(const Cage& g, sint point) {
    return moved(g.place, cage_point(g, point));
}

/// The weights of a page, made by the host if nobody asked for it before.
inline pointer<float> page_weights(const Context& c, const Cage& g, sint face_class, PageKind kind,
                                   sint index) {
    int k = static_cast<int>(kind);
    pointer<ClassRecord> record = g.classes + face_class;
    pointer<PageEntry> entries = load(field(record, &ClassRecord::entries));
    pointer<Line> lines = load(field(record, &ClassRecord::lines));
    sint first = load(field(record, &ClassRecord::first) + k);
    pointer<shared_int> entry = field(entries + (first + index), &PageEntry::line);
    sint line = load_acquire(entry);
    if (branch(line == 0)) {
        tally(c.counters->pages_requested, 1);
        request_page(*c.pages, face_class, k, index);
        line = load_acquire(entry);
    }
    return as<float>(lines + line);
}

/// The sum of weights x points over `n` controls from `first` on, in mesh coordinates: one lane a control.
inline svec weigh_row(const Cage& g, pointer<float> row, sint first, sint n) {
    // Summed as 64 lanes would sum it, so that no bit depends on the width.
    constexpr int parts = 64 / isa::width;
    vfloat zero(0.0F);
    vvec sum[parts];
    for (vvec& part : sum)
        part = {zero, zero, zero};
    for (sint i = 0; branch(i < n); i += 64) {
        for (int k = 0; k < parts; ++k) {
            sint from = i + k * isa::width;
            if (branch(from < n)) {
                vmask m = first_lanes(n - from);
                vfloat w = load_vector(row + from, m);
                vint point = load_vector(g.controls + (first + from), m);
                vint at = point * vint(3);
                vfloat x = gather(g.points, at, m);
                vfloat y = gather(g.points + 1, at, m);
                vfloat z = gather(g.points + 2, at, m);
                sum[k].x = fma(w, x, sum[k].x);
                sum[k].y = fma(w, y, sum[k].y);
                sum[k].z = fma(w, z, sum[k].z);
            }
        }
    }
    for (int half = parts / 2; half >= 1; half /= 2)
        for (int k = 0; k < half; ++k)
            sum[k] = sum[k] + sum[k + half];
    svec p;
    p.x = reduce_add(sum[0].x);
    p.y = reduce_add(sum[0].y);
    p.z = reduce_add(sum[0].z);
    return p;
}

/// Number of a curve's page: of a chunk at this exponent.
inline sint curve_page_index(const Cage& g, sint face_class, sint local, sint flags, sint exponent,
                             sint chunk) {
    sint ways = load(field(g.classes + face_class, &ClassRecord::curve_ways));
    sint chunks_before = exponent; // strip_first(exponent)
    if (branch(exponent > block_log2))
        chunks_before = strip_first_large(sint(1) << (exponent - block_log2));
    sint reversed = flags & curve_owner_reversed;
    sint strip = chunks_before + chunk;
    sint way = local * 2 + reversed;
    return strip * ways + way;
}

inline void put_point(pointer<float> points, sint lane, const svec& p) {
    store(points + lane, p.x);
    store(points + curve_row + lane, p.y);
    store(points + 2 * curve_row + lane, p.z);
}
inline svec get_point(pointer<const float> points, sint lane) {
    svec p;
    p.x = load(points + lane);
    p.y = load(points + curve_row + lane);
    p.z = load(points + 2 * curve_row + lane);
    return p;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
