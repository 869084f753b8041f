// What hanging vertices leave open beside their flat ancestor edge is filled.
#pragma once

#include "razor/kernels/triangles.h"

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

struct Edge {
    Projected p, q;
};

/// Number of vertex i along side s.
inline sint side_vertex(const View& v, int s, sint i) {
    sint width = v.quads_u + 1;
    if (s == 1)
        return i * width + v.quads_u;
    if (s == 2)
        return width * v.quads_v + i;
    return s == 3 ? i * width : i;
}

/// The flat ancestor of the sub-edge from vertex number `i` to i+1 along side s.
inline Edge ancestor_edge(const Group& g, const View& v, int s, sint hang, sint i) {
    sint quads = s % 2 == 0 ? v.quads_u : v.quads_v;
    Projected ends[2];
    if (branch((sint(1) << hang) > quads)) {
        pointer<float> end = v.words + v.ancestors_at + 6 * s;
        for (int k = 0; k < 2; ++k) {
            vfloat x = load_broadcast(end + g.kx);
            vfloat y = load_broadcast(end + g.ky);
            vfloat z = load_broadcast(end + g.kz);
            ends[k] = project(g, v, x, y, z);
            end = end + 3;
        }
    } else {
        sint first = (i >> hang) << hang;
        for (int k = 0; k < 2; ++k) {
            sint along = k == 0 ? first : first + (sint(1) << hang);
            sint vertex = side_vertex(v, s, along);
            ends[k] = project_vertex(g, v, vertex);
        }
    }
    return {ends[0], ends[1]};
}

/// On which sides of the block the quad lies.
struct Border {
    sbool side[4];
};
inline Border border_of(const View& v, sint i, sint j) {
    sint last_u = v.quads_u - 1;
    sint last_v = v.quads_v - 1;
    return {{j == 0, i == last_u, j == last_v, i == 0}};
}

/// Numbers on one line in a ray's plane: where two edges run, in the direction in which one of them is
/// longest.
struct Along {
    vfloat begin, end;
};
inline Along along(const vmask& steep, const Edge& e) {
    return {select(steep, e.p.y, e.p.x), select(steep, e.q.y, e.q.x)};
}

inline constexpr float gap_slacks =
    4.5F; // how wide gaps are at most, in slacks of positions, sheared: with room

/// A side with hanging vertices leaves its flat ancestor edge, which is all that the neighbour knows of, by
/// their rounding. What lies between the ancestor and sub-edge i, over the sub-edge's length, belongs to this
/// block, and is hit as a point of the sub-edge. Lengths of sub-edges add up to the ancestor's exactly, so
/// that modulo 2 every point is covered as if the gap were filled with triangles: the surface is closed in
/// every projection, folded or not.
inline void fill_gap(const Group& g, const View& v, int s, sint hang, sint i, sint triangle,
                     const vmask& seen, Hits& hits) {
    Edge whole = ancestor_edge(g, v, s, hang, i);
    Edge part;
    part.p = project_vertex(g, v, side_vertex(v, s, i));
    part.q = project_vertex(g, v, side_vertex(v, s, i + 1));
    vfloat dx = abs(whole.q.x - whole.p.x);
    vfloat dy = abs(whole.q.y - whole.p.y);
    vmask steep = dy > dx;
    Along of_part = along(steep, part);
    vfloat zero(0.0F);
    vmask inside = seen & (min(of_part.begin, of_part.end) <= zero);
    inside = inside & (max(of_part.begin, of_part.end) >= zero);
    if (branch(none(inside)))
        return;
    Along of_whole = along(steep, whole);
    vfloat part_side = exact_edge_function(part.p, part.q);
    vfloat whole_side = exact_edge_function(whole.p, whole.q);
    vmask backward = of_part.end < of_part.begin;
    part_side = select(backward, -part_side, part_side);
    backward = of_whole.end < of_whole.begin;
    whole_side = select(backward, -whole_side, whole_side);
    vmask point = of_whole.begin == of_whole.end;
    whole_side = select(point, vfloat(1.0F), whole_side);
    inside = inside & (min(part_side, whole_side) <= zero);
    inside = inside & (max(part_side, whole_side) >= zero);
    if (branch(none(inside)))
        return;
    vfloat length = of_part.begin - of_part.end;
    point = length == zero;
    vfloat place = of_part.begin / select(point, vfloat(1.0F), length);
    vfloat depth = fma(place, part.q.z - part.p.z, part.p.z);
    vfloat t = depth * g.scale_z;
    vfloat rest = vfloat(1.0F) - place;
    vint number = vint(triangle + (s >> 1));
    vmask hit = nearer(g, v, inside, t, number, hits);
    vfloat u = s == 3 ? zero : s == 1 ? rest : place;
    vfloat w = s == 0 ? zero : s == 2 ? rest : place;
    record(v, hit, t, u, w, number, hits);
}

/// Rays that may meet a gap along side s of a quad, whose edge function there is given: hanging vertices are
/// off their ancestor by the rounding of means, less than positions may be.
inline vmask near_gap(const Group& g, const View& v, const Border& border, int s, const vfloat& side,
                      const Projected& p, const Projected& q) {
    if (branch(!(border.side[s] & (v.longest[s] > 0))))
        return vmask(false);
    vfloat dx = abs(q.x - p.x);
    vfloat dy = abs(q.y - p.y);
    vfloat length = dx + dy;
    sfloat room = g.slack * gap_slacks;
    vfloat most = length * vfloat(room);
    return g.alive & (abs(side) <= most);
}

/// Rays that see the quad's triangle beside side s.
inline vmask see_beside(const Group& g, const View& v, int s, sint low) {
    sint high = low + v.quads_u + 1;
    Projected a = project_vertex(g, v, low);
    Projected b = project_vertex(g, v, s < 2 ? low + 1 : high + 1);
    Projected c = project_vertex(g, v, s < 2 ? high + 1 : high);
    vfloat ab = exact_edge_function(a, b);
    vfloat bc = exact_edge_function(b, c);
    vfloat det = ab + bc;
    det = det + exact_edge_function(c, a);
    return g.alive & is_seen(g, v, det);
}

/// For these, out of line: seldom called.
[[gnu::noinline]] inline void fill_gaps(const Group& g, const View& v, sint i, sint j, Hits& hits) {
    Border border = border_of(v, i, j);
    sint quad = ((j << block_log2) + i) * 2;
    sint triangle = (v.number << 7) + quad;
    for (int s = 0; s < 4; ++s) {
        if (branch(border.side[s] & (v.longest[s] > 0))) {
            vmask seen = g.alive;
            if (branch(v.from != seen_from_both_sides))
                seen = see_beside(g, v, s, j * (v.quads_u + 1) + i);
            for (sint hang = max(v.hang[s], 1); branch(hang <= v.longest[s]); ++hang)
                fill_gap(g, v, s, hang, s % 2 == 0 ? i : j, triangle, seen, hits);
        }
    }
}

} // namespace intersect_kernel
} // namespace razor::ISA_TARGET
