// A packet of rays against a block. Watertight (Woop, Benthin & Wald, JCGT 2013): every vertex is sheared
// into the ray's frame, edge functions of shared edges are the same bits with opposite signs, and an edge
// function that rounds to zero is decided by its exact error terms. What hanging vertices leave open beside
// their flat ancestor edge is filled. Lanes are rays; vertices are broadcast. Which cells to try is found
// with one lane a cell.
#pragma once

#include "razor/kernels/blend.h"
#include "razor/kernels/fields.h"
#include "razor/kernels/kd_build.h"

#include <cstddef>
#include <type_traits>

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

/// What inner loops are compiled for. The plan picks an instantiation; absent features leave no branch there.
struct Features {
    bool hanging = true; // some patch has sides coarser than its grid
};

struct Hits {
    vfloat t;
    vfloat u, v;   // barycentric weights of the triangle's second and third vertex
    vint patch;    // -1: none
    vint triangle; // block number * 128 + quad (row * 8 + column) * 2 + which
    vint block;    // first line of the block in the grids
    vint field;    // the lane whose field the block was blended for; -1: it was not
};

/// A group of rays of one packet whose directions agree in largest component, with all that is common to
/// them.
struct Group {
    vmask alive;
    sint kx, ky, kz;         // permutation: z is the largest component
    vfloat ox, oy, oz;       // origin, permuted
    vfloat shear_x, shear_y; // d_x / d_z, d_y / d_z
    vfloat scale_z;          // 1 / d_z
    vfloat t_min;
    sbool mixed[3]; // whether the directions' components differ in sign (unpermuted axes)
    sint sign[3];   // 1: the component is negative; of the first ray, where they differ
    sfloat flip[3]; // 1 or -1
    sfloat near[3],
        far[3]; // bounds of flip * origin, with slack: a plane is entered no earlier, left no later
    sfloat least[3], most[3]; // bounds of |1 / direction|
    sfloat first_t;           // least t_min
    sfloat slack;             // of positions
    sbool morphs;             // whether vertices leave their anchors
    FieldBounds fields;
};

struct Projected {
    vfloat x, y, z;
};

/// p x q - their order's edge function; exact in sign unless it is zero.
inline vfloat edge_function(const Projected& p, const Projected& q) {
    vfloat a = p.x * q.y;
    vfloat b = p.y * q.x;
    return a - b;
}
/// The same, exact in sign always: where the rounded products are equal, their errors decide.
inline vfloat exact_edge_function(const Projected& p, const Projected& q) {
    vfloat a = p.x * q.y;
    vfloat b = p.y * q.x;
    vfloat d = a - b;
    vfloat a_error = product_error(p.x, q.y, a);
    vfloat b_error = product_error(p.y, q.x, b);
    vfloat tie = a_error - b_error;
    return select(d == vfloat(0.0F), tie, d);
}

/// The block as the group sees it: permuted component arrays, origin moved to mesh coordinates.
struct View {
    pointer<float> x, y, z;
    pointer<float> words;
    vfloat ox, oy, oz;
    sint line, patch, number, triangles;
    sint quads_u, quads_v;
    sint cells_at, ancestors_at, hang[4], hangs;
    /// log2 of the sub-edges on the longest edge that a coarser block may have in their place; hang or more.
    sint longest[4];
    sint field; // as in Hits
};

inline Projected project(const Group& g, const View& v, const vfloat& x, const vfloat& y, const vfloat& z) {
    vfloat px = x - v.ox;
    vfloat py = y - v.oy;
    Projected p;
    p.z = z - v.oz;
    p.x = fnma(g.shear_x, p.z, px);
    p.y = fnma(g.shear_y, p.z, py);
    return p;
}
[[gnu::always_inline]] inline Projected project_vertex(const Group& g, const View& v, sint i) {
    vfloat x = load_broadcast(v.x + i);
    vfloat y = load_broadcast(v.y + i);
    vfloat z = load_broadcast(v.z + i);
    return project(g, v, x, y, z);
}

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

/// Of the lanes that meet triangle `number` at distance t, those for which it is the first hit so far.
[[gnu::always_inline]] inline vmask nearer(const Group& g, const View& v, const vmask& inside,
                                           const vfloat& t, const vint& number, const Hits& hits) {
    vmask first = t < hits.t;
    vmask equal = t == hits.t;
    if (branch(any(inside & equal))) {
        vint patch = vint(v.patch);
        vmask lower = patch < hits.patch;
        vmask same = patch == hits.patch;
        same = same & (number < hits.triangle);
        lower = lower | same;
        lower = lower | (hits.patch < vint(0));
        first = first | (equal & lower);
    }
    vmask hit = inside & first;
    return hit & (t >= g.t_min);
}

[[gnu::always_inline]] inline void record(const View& v, const vmask& hit, const vfloat& t, const vfloat& u,
                                          const vfloat& w, const vint& number, Hits& hits) {
    hits.t = select(hit, t, hits.t);
    hits.u = select(hit, u, hits.u);
    hits.v = select(hit, w, hits.v);
    hits.patch = select(hit, vint(v.patch), hits.patch);
    hits.triangle = select(hit, number, hits.triangle);
    hits.block = select(hit, vint(v.line), hits.block);
    hits.field = select(hit, vint(v.field), hits.field);
}

/// Takes the hits of triangle (a, b, c) with edge functions U (opposite a), V, W, all in one sense.
[[gnu::always_inline]] inline void accept(const Group& g, const View& v, vmask inside, vfloat U, vfloat V,
                                          vfloat W, const Projected& a, const Projected& b,
                                          const Projected& c, sint triangle, Hits& hits) {
    vfloat sum = U + V;
    vfloat det = sum + W;
    inside = inside & (det != vfloat(0.0F));
    vfloat inverse = reciprocal(det);
    vfloat depth = fma(U, a.z, fma(V, b.z, W * c.z));
    vfloat t = depth * g.scale_z * inverse;
    vint number = vint(triangle);
    vmask hit = nearer(g, v, inside, t, number, hits);
    if (branch(any(hit))) {
        vfloat u = V * inverse;
        vfloat w = W * inverse;
        record(v, hit, t, u, w, number, hits);
    }
}

/// Lanes for which the three edge functions agree in sign; zero agrees with both.
inline vmask agree(const vfloat& u, const vfloat& v, const vfloat& w) {
    vfloat zero(0.0F);
    vfloat least = min(u, min(v, w));
    vfloat most = max(u, max(v, w));
    vmask same = least >= zero;
    return same | (most <= zero);
}

/// For lanes that may hit the quad's triangles, (00, 10, 11) and (00, 11, 01): decides exactly, and takes the
/// hits. Seldom called and out of line, so that the inner loop keeps nothing for it: it projects the vertices
/// again.
[[gnu::noinline]] inline void hit_quad(const Group& g, const View& v, sint i, sint j, sint low, sint high,
                                       vmask inside0, vmask inside1, Hits& hits) {
    Projected p00 = project_vertex(g, v, low);
    Projected p10 = project_vertex(g, v, low + 1);
    Projected p11 = project_vertex(g, v, high + 1);
    Projected p01 = project_vertex(g, v, high);
    sint quad = ((j << block_log2) + i) * 2;
    sint triangle = (v.number << 7) + quad;
    vfloat minus = exact_edge_function(p11, p00);
    if (branch(any(inside0))) {
        vfloat right = exact_edge_function(p10, p11);
        vfloat bottom = exact_edge_function(p00, p10);
        inside0 = inside0 & agree(right, minus, bottom);
        accept(g, v, inside0, right, minus, bottom, p00, p10, p11, triangle, hits);
    }
    sbool second = v.triangles > 1;
    if (branch(second & any(inside1))) {
        // All three the other way round: only their ratios count.
        vfloat top = exact_edge_function(p01, p11);
        vfloat left = exact_edge_function(p00, p01);
        inside1 = inside1 & agree(top, left, minus);
        accept(g, v, inside1, top, left, minus, p00, p11, p01, triangle + 1, hits);
    }
}

/// Numbers on one line in a ray's plane: where two edges run, in the direction in which one of them is
/// longest.
struct Along {
    vfloat begin, end;
};
inline Along along(const vmask& steep, const Edge& e) {
    return {select(steep, e.p.y, e.p.x), select(steep, e.q.y, e.q.x)};
}

inline constexpr float gap_slacks = 4.0F; // how wide gaps are at most, in slacks of positions: with room

/// A side with hanging vertices leaves its flat ancestor edge, which is all that the neighbour knows of, by
/// their rounding. What lies between the ancestor and sub-edge i, over the sub-edge's length, belongs to this
/// block, and is hit as a point of the sub-edge. Lengths of sub-edges add up to the ancestor's exactly, so
/// that modulo 2 every point is covered as if the gap were filled with triangles: the surface is closed in
/// every projection, folded or not.
inline void fill_gap(const Group& g, const View& v, int s, sint hang, sint i, sint triangle, Hits& hits) {
    Edge whole = ancestor_edge(g, v, s, hang, i);
    Edge part;
    part.p = project_vertex(g, v, side_vertex(v, s, i));
    part.q = project_vertex(g, v, side_vertex(v, s, i + 1));
    vfloat dx = abs(whole.q.x - whole.p.x);
    vfloat dy = abs(whole.q.y - whole.p.y);
    vmask steep = dy > dx;
    Along of_part = along(steep, part);
    vfloat zero(0.0F);
    vmask inside = g.alive & (min(of_part.begin, of_part.end) <= zero);
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

/// For these, out of line: seldom called.
[[gnu::noinline]] inline void fill_gaps(const Group& g, const View& v, sint i, sint j, Hits& hits) {
    Border border = border_of(v, i, j);
    sint quad = ((j << block_log2) + i) * 2;
    sint triangle = (v.number << 7) + quad;
    for (int s = 0; s < 4; ++s) {
        if (branch(border.side[s] & (v.longest[s] > 0))) {
            for (sint hang = max(v.hang[s], 1); branch(hang <= v.longest[s]); ++hang)
                fill_gap(g, v, s, hang, s % 2 == 0 ? i : j, triangle, hits);
        }
    }
}

/// Cells whose box, widened, some ray of the group may meet before its present hit: conservative, by interval
/// arithmetic.
inline vmask cells_met(const Group& g, const View& v, const svec& origin, sfloat widen, sint from, sint cells,
                       sfloat last_t) {
    sfloat shift[3] = {origin.x, origin.y, origin.z};
    vfloat enter = vfloat(g.first_t);
    vfloat leave = vfloat(last_t);
    vmask m = first_lanes(cells - from);
    pointer<float> low = v.words + v.cells_at + from;
    for (int k = 0; k < 3; ++k) {
        if (branch(g.mixed[k]))
            continue;
        // With the axis flipped to a positive direction: entering plane minus the furthest origin, and so on.
        sint near_at = g.sign[k] * (3 * cell_boxes);
        sint far_at = sint(3 * cell_boxes) - near_at;
        vfloat near_plane = load_vector(low + k * cell_boxes + near_at, m);
        vfloat far_plane = load_vector(low + k * cell_boxes + far_at, m);
        sfloat moved = g.flip[k] * shift[k];
        vfloat flip = vfloat(g.flip[k]);
        sfloat near_origin = g.near[k] - moved + widen;
        sfloat far_origin = g.far[k] - moved - widen;
        vfloat near_distance = near_plane * flip;
        near_distance = near_distance - vfloat(near_origin);
        vfloat far_distance = far_plane * flip;
        far_distance = far_distance - vfloat(far_origin);
        vfloat least = vfloat(g.least[k]);
        vfloat most = vfloat(g.most[k]);
        vmask ahead = near_distance >= vfloat(0.0F);
        vfloat near_rate = select(ahead, least, most);
        vmask before = far_distance >= vfloat(0.0F);
        vfloat far_rate = select(before, most, least);
        enter = max(near_distance * near_rate, enter);
        leave = min(far_distance * far_rate, leave);
    }
    return m & (enter <= leave);
}

/// The up to 2 x 2 quads of a cell, row by row; neighbours in a row share two vertices and an edge.
template <Features F>
inline void intersect_cell(const Context& c, const Group& g, const View& v, sint column, sint row,
                           Hits& hits) {
    sint end_u = min(column + 2, v.quads_u);
    sint end_v = min(row + 2, v.quads_v);
    sint width = v.quads_u + 1;
    sint low_row = row * width;
    for (sint j = row; branch(j < end_v); ++j) {
        sint low = low_row + column;
        low_row = low_row + width;
        sint high = low_row + column;
        Projected p00 = project_vertex(g, v, low);
        Projected p01 = project_vertex(g, v, high);
        vfloat left = edge_function(p00, p01);
        for (sint i = column; branch(i < end_u); ++i) {
            tally(c.counters->quad_tests, 1);
            Projected p10 = project_vertex(g, v, low + 1);
            Projected p11 = project_vertex(g, v, high + 1);
            vfloat bottom = edge_function(p00, p10);
            vfloat right = edge_function(p10, p11);
            vfloat top = edge_function(p01, p11);
            vfloat minus = edge_function(p11, p00); // of the diagonal, reversed
            vfloat next_left = right;
            vmask inside0 = agree(bottom, right, minus) & g.alive;
            vmask inside1 = agree(minus, top, left) & g.alive;
            if (branch(any(inside0 | inside1)))
                hit_quad(g, v, i, j, low, high, inside0, inside1, hits);
            if constexpr (F.hanging) {
                if (branch(v.hangs != 0)) {
                    Border border = border_of(v, i, j);
                    vmask near = near_gap(g, v, border, 0, bottom, p00, p10);
                    near = near | near_gap(g, v, border, 1, right, p10, p11);
                    near = near | near_gap(g, v, border, 2, top, p01, p11);
                    near = near | near_gap(g, v, border, 3, left, p00, p01);
                    if (branch(any(near)))
                        fill_gaps(g, v, i, j, hits);
                }
            }
            p00 = p10;
            p01 = p11;
            left = next_left;
            ++low;
            ++high;
        }
    }
}

/// The packet's rays against boxes, unpermuted.
struct Slabs {
    vfloat origin[3], inverse[3], error[3];
};

/// Distances between which rays are in a box, one a lane.
struct Interval {
    vfloat enter, leave;
};

/// Those of a box widened by the slack of positions. Its planes lie at low[k * step] and at low[(k + 3) *
/// step].
template <bool Mixed>
inline Interval box_interval(const Group& g, const Slabs& rays, pointer<const float> low, sint step) {
    Interval i;
    for (int k = 0; k < 3; ++k) {
        sint half = step * 3;
        sint near_at = select(g.sign[k] != 0, half, sint(0));
        sint far_at = half - near_at;
        pointer<const float> plane = low + step * k;
        vfloat near = load_broadcast(plane + near_at);
        vfloat far = load_broadcast(plane + far_at);
        near = (near - rays.origin[k]) * rays.inverse[k];
        far = (far - rays.origin[k]) * rays.inverse[k];
        if constexpr (Mixed) {
            vfloat first = min(near, far);
            far = max(near, far);
            near = first;
        }
        near = near - rays.error[k];
        far = far + rays.error[k];
        i.enter = k == 0 ? near : max(near, i.enter);
        i.leave = k == 0 ? far : min(far, i.leave);
    }
    return i;
}

/// Lanes whose ray meets a box before its present hit.
template <bool Mixed>
inline vmask rays_meet(const Group& g, const Slabs& rays, pointer<const float> low, sint step,
                       const vfloat& last_t) {
    Interval i = box_interval<Mixed>(g, rays, low, step);
    vfloat enter = max(i.enter, g.t_min);
    return g.alive & (enter <= min(i.leave, last_t));
}

/// The block's vertices as the group sees them: blended ones or, at its own place, anchors.
inline void set_vertices(const Group& g, View& v, sint stride, pointer<float> words,
                         pointer<float> origin_at) {
    v.words = words;
    pointer<float> vertices = words + block_header_words;
    v.x = vertices + stride * g.kx;
    v.y = vertices + stride * g.ky;
    v.z = vertices + stride * g.kz;
    vfloat mx = load_broadcast(origin_at + g.kx);
    vfloat my = load_broadcast(origin_at + g.ky);
    vfloat mz = load_broadcast(origin_at + g.kz);
    v.ox = g.ox - mx;
    v.oy = g.oy - my;
    v.oz = g.oz - mz;
}

/// What a visitor returns that wants no further cell.
struct stop_visiting {};

/// Calls visit(column, row) for each cell of the block that rays of the group meet, its box widened.
template <bool Mixed, class Visit>
inline void visit_cells(const Group& g, const View& v, const Slabs& scene, sfloat widen,
                        pointer<float> origin_at, const Hits& hits, Visit visit) {
    if (branch(v.cells_at == 0)) {
        visit(sint(0), sint(0));
        return;
    }
    Slabs rays;
    for (int k = 0; k < 3; ++k) {
        rays.origin[k] = scene.origin[k] - load_broadcast(origin_at + k);
        rays.inverse[k] = scene.inverse[k];
        vfloat rate = abs(scene.inverse[k]);
        rays.error[k] = fma(rate, vfloat(widen), scene.error[k]);
    }
    svec origin = load_svec(origin_at);
    sint shift = cells_shift(v.quads_u);
    sint cells = ((v.quads_v + 1) >> 1) << shift;
    vfloat furthest = select(g.alive, hits.t, vfloat(-3.0e38F));
    sfloat last_t = reduce_max(furthest);
    for (sint from = 0; branch(from < cells); from += isa::width) {
        vmask met = cells_met(g, v, origin, widen, from, cells, last_t);
        for (; branch(any(met)); met = clear_first(met)) {
            sint cell = from + first(met);
            pointer<const float> box = v.words + v.cells_at + cell;
            vmask lanes = rays_meet<Mixed>(g, rays, box, cell_boxes, hits.t);
            if (branch(none(lanes)))
                continue;
            sint row = cell >> shift;
            sint column = cell - (row << shift);
            sint column_begin = column * 2;
            if constexpr (std::is_void_v<decltype(visit(sint(0), sint(0)))>) {
                visit(column_begin, row * 2);
            } else {
                visit(column_begin, row * 2);
                return;
            }
        }
    }
}

/// What a leaf says of the blocks it lists.
struct Listed {
    sint line;
    pointer<const float> box; // in scene coordinates
    sint box_step;
    sint level; // of the leaf
};

/// Beside a block whose vertices along a side are means of their parents, a coarser one may have the edge
/// that these lie on but for their rounding. log2 of its sub-edges, as long as the block at most.
inline sint longest_edge(const View& v, int s, pointer<float> weights) {
    sint longest = v.hang[s];
    sint quads = s % 2 == 0 ? v.quads_u : v.quads_v;
    for (;;) {
        sint step = sint(1) << longest;
        if (branch(step + step > quads))
            return longest;
        for (sint i = step; branch(i < quads); i += step + step) {
            sfloat weight = load(weights + side_vertex(v, s, i));
            if (branch(weight != 0.0F))
                return longest;
        }
        ++longest;
    }
}

/// Those of a block just blended, kept with it; where one is longer than the block, its ends as well.
inline void find_longest_edges(const Context& c, const Field& seen, const View& v,
                               pointer<BlockHeader> header, pointer<float> slot) {
    pointer<float> words = slot + slot_block;
    for (int s = 0; s < 4; ++s) {
        sint longest = longest_edge(v, s, words + blend_weights);
        sint quads = s % 2 == 0 ? v.quads_u : v.quads_v;
        if (branch((sint(1) << longest) == quads)) {
            sbool whole = blend_whole_edge(c, seen, header, s, words);
            longest = longest + select(whole, sint(1), sint(0));
        }
        store(as<std::int32_t>(slot) + (slot_longest + s), longest);
    }
}

/// The same for rays that see the block's vertices off their anchors: blended once a field, and kept.
template <Features F, bool Mixed>
[[gnu::noinline]] inline void intersect_blended(const Context& c, Group& g, View v, const Listed& listed,
                                                const Slabs& rays, sint stride, vmask moved, sfloat most,
                                                Hits& hits) {
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + listed.line);
    sint instance = load(field(header, &BlockHeader::instance));
    pointer<float> origin_at = field(c.instances + instance, &InstanceRecord::origin);
    sfloat sway = sway_of(c, header, most);
    if constexpr (F.hanging) {
        v.ancestors_at = blend_ancestors;
        for (int s = 0; s < 4; ++s)
            v.hang[s] = hang_at(header, s, listed.level);
    }
    svec origin = load_svec(origin_at);
    sint anchors_cells_at = v.cells_at;
    vint numbers = load_vector(as<std::int32_t>(c.packets + packet_number));
    while (branch(any(moved))) {
        sint lane = first(moved);
        sint number = extract(numbers, lane);
        vmask same = moved & (numbers == vint(number));
        moved = moved & !same;
        g.alive = same;
        pointer<float> slot = blend_slot(c, number, listed.line);
        sbool there = holds_block(slot, number, listed.line);
        there = there & (load(as<std::int32_t>(slot) + slot_level) == listed.level);
        if (branch(!there)) {
            // It is blended only if they meet a cell where its vertices may be.
            v.cells_at = anchors_cells_at;
            v.words = as<float>(header);
            sbool near = false;
            auto note = [&](sint, sint) {
                near = true;
                return stop_visiting{};
            };
            visit_cells<Mixed>(g, v, rays, sway, origin_at, hits, note);
            if (branch(!near))
                continue;
            Field seen = field_of(c, lane, origin);
            blend_block(c, seen, number, listed.line, listed.level, slot);
            if constexpr (F.hanging)
                find_longest_edges(c, seen, v, header, slot);
        }
        tally(c.counters->blended_tests, 1);
        v.field = lane;
        pointer<float> words = slot + slot_block;
        set_vertices(g, v, stride, words, origin_at);
        if constexpr (F.hanging) {
            v.hangs = 0;
            for (int s = 0; s < 4; ++s) {
                v.longest[s] = load(as<std::int32_t>(slot) + (slot_longest + s));
                v.hangs = v.hangs | v.longest[s];
            }
        }
        v.cells_at = select(anchors_cells_at != 0, sint(blend_cells), sint(0));
        auto visit = [&](sint column, sint row) {
            tally(c.counters->cell_tests, 1);
            intersect_cell<F>(c, g, v, column, row, hits);
        };
        visit_cells<Mixed>(g, v, rays, 0.0F, origin_at, hits, visit);
    }
}

/// Rays of the group against a block listed by a leaf that is fine enough for all of them, if any meets its
/// box while it is in the leaf's cell; returns whether. Those to which all
/// its vertices are at their anchors take it as it lies; for the others it is blended, once a field.
template <Features F, bool Mixed>
[[gnu::noinline]] inline sbool intersect_block(const Context& c, Group& g, const Listed& listed,
                                               const Interval& cell, Hits& hits) {
    phase_scope phase(phase_intersect);
    Slabs rays;
    for (int k = 0; k < 3; ++k) {
        rays.origin[k] = load_vector(c.packets + (packet_origin + k * isa::width));
        rays.inverse[k] = load_vector(c.packets + (packet_inverse + k * isa::width));
        rays.error[k] = load_vector(c.packets + (packet_error + k * isa::width));
    }
    tally(c.counters->box_tests, 1);
    Interval inside = box_interval<Mixed>(g, rays, listed.box, listed.box_step);
    vfloat enter = max(inside.enter, cell.enter);
    vmask in_cell = g.alive & (enter <= min(inside.leave, cell.leave));
    if (branch(none(in_cell)))
        return false;
    enter = max(inside.enter, g.t_min);
    vmask met = g.alive & (enter <= min(inside.leave, hits.t));
    tally(c.counters->block_tests, 1);
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + listed.line);
    sint instance = load(field(header, &BlockHeader::instance));
    pointer<float> origin_at = field(c.instances + instance, &InstanceRecord::origin);
    View v;
    v.line = listed.line;
    v.words = as<float>(header);
    v.patch = load(field(header, &BlockHeader::patch));
    v.number = load(field(header, &BlockHeader::number));
    v.triangles = load(field(header, &BlockHeader::triangles));
    v.quads_u = load(field(header, &BlockHeader::quads_u));
    v.quads_v = load(field(header, &BlockHeader::quads_v));
    v.cells_at = load(field(header, &BlockHeader::cells_at));
    v.field = -1;
    sint stride = load(field(header, &BlockHeader::stride));
    if constexpr (F.hanging) {
        v.hangs = load(field(header, &BlockHeader::hangs));
        v.ancestors_at = load(field(header, &BlockHeader::ancestors_at));
        for (int s = 0; s < 4; ++s)
            v.longest[s] = v.hang[s] = load(field(header, &BlockHeader::hang) + s);
    }
    vmask all = g.alive;
    vmask moved = vmask(false);
    sfloat most = 0.0F;
    if constexpr (F.hanging) {
        sint movable = load(field(header, &BlockHeader::movable));
        if (branch(g.morphs & (movable != 0))) {
            svec origin = load_svec(origin_at);
            pointer<float> box = field(header, &BlockHeader::box_low);
            if (branch(v.ancestors_at != 0))
                box = v.words + (v.ancestors_at + ancestor_box);
            svec low = load_svec(box) + origin;
            svec high = load_svec(box + 3) + origin;
            sint absolute = load(field(header, &BlockHeader::absolute));
            sfloat begin = moving_from(absolute);
            CommonTargets all_fields = common_targets_in(g.fields, low, high, g.slack);
            sbool some = all_fields.most > begin;
            if (branch(some | (absolute < listed.level))) {
                Targets t = targets_in(c, g.fields, low, high, g.slack);
                moved = met & (t.most > vfloat(begin));
                moved = moved | (met & vmask(absolute < listed.level));
                most = reduce_max(select(moved, t.most, vfloat(0.0F)));
            }
        }
    }
    vmask plain = met & !moved;
    pointer<float> block = as<float>(header);
    set_vertices(g, v, stride, block, origin_at);
    if (branch(any(plain))) {
        tally(c.counters->plain_tests, 1);
        g.alive = plain;
        auto visit = [&](sint column, sint row) {
            tally(c.counters->cell_tests, 1);
            intersect_cell<F>(c, g, v, column, row, hits);
        };
        visit_cells<Mixed>(g, v, rays, 0.0F, origin_at, hits, visit);
    }
    if constexpr (F.hanging) {
        if (branch(any(moved)))
            intersect_blended<F, Mixed>(c, g, v, listed, rays, stride, moved, most, hits);
    }
    g.alive = all;
    return true;
}

} // namespace intersect_kernel
} // namespace razor::ISA_TARGET
