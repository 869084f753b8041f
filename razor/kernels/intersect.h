// A packet of rays against a block. Which cells to try is found with one lane a cell.
#pragma once

#include "razor/kernels/gaps.h"
#include "razor/kernels/kd_build.h"

#include <type_traits>

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

/// Boxes of m, one a lane, widened and moved by `origin`, that the beam meets between `begin` and `end`.
/// Planes of axis k lie at low[k * step] and low[(k + 3) * step].
inline vmask boxes_met(const Group& g, pointer<const float> low, sint step, const svec& origin, sfloat widen,
                       sfloat begin, sfloat end, const vmask& m) {
    sint half = step * 3;
    sfloat moved = component(origin, g.kz);
    pointer<const float> side = low + step * g.kz;
    vfloat from = load_vector(side, m);
    vfloat to = load_vector(side + half, m);
    from = max(from, vfloat(begin - moved - widen));
    to = min(to, vfloat(end - moved + widen));
    vmask met = m & (from <= to);
    for (int k = 0; k < 2; ++k) {
        sint axis = k == 0 ? g.kx : g.ky;
        side = low + step * axis;
        vfloat lowest = load_vector(side, m);
        vfloat highest = load_vector(side + half, m);
        sfloat shift = component(origin, axis);
        // The line below is lowest where the box begins, if it rises, and so on.
        sfloat rate = g.beam.low_rate[k];
        sfloat base = fma(rate, moved, g.beam.low_base[k]);
        sfloat wider = fma(abs(rate), widen, widen);
        base = base - shift - wider;
        vmask rises = vmask(rate > 0.0F);
        vfloat at = select(rises, from, to);
        vfloat slope = vfloat(rate);
        at = fma(at, slope, vfloat(base));
        met = met & (highest >= at);
        rate = g.beam.high_rate[k];
        base = fma(rate, moved, g.beam.high_base[k]);
        wider = fma(abs(rate), widen, widen);
        base = base - shift + wider;
        rises = vmask(rate > 0.0F);
        at = select(rises, to, from);
        slope = vfloat(rate);
        at = fma(at, slope, vfloat(base));
        met = met & (lowest <= at);
    }
    return met;
}

/// The up to 2 x 2 quads of a cell, row by row; neighbours in a row share two vertices and an edge.
template <Features F, class Seen>
inline void intersect_cell(const Context& c, const Group& g, const Seen& v, sint column, sint row,
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
    vfloat inverse[3], early[3], late[3]; // as in scratch.h
};
inline Slabs load_slabs(const Context& c) {
    Slabs rays;
    for (int k = 0; k < 3; ++k) {
        rays.inverse[k] = load_vector(c.packets + (packet_inverse + k * isa::width));
        rays.early[k] = load_vector(c.packets + (packet_early + k * isa::width));
        rays.late[k] = load_vector(c.packets + (packet_late + k * isa::width));
    }
    return rays;
}

/// Distances between which rays are in a box, one a lane.
struct Interval {
    vfloat enter, leave;
};

/// Those of a box widened by the slack of positions. Its planes lie at low[k * step] and at low[(k + 3) *
/// step].
template <bool Mixed>
[[gnu::always_inline]] inline Interval box_interval(const Group& g, const Slabs& rays,
                                                    pointer<const float> low, sint step) {
    Interval i;
    for (int k = 0; k < 3; ++k) {
        sint half = step * 3;
        sint near_at = select(g.sign[k] != 0, half, sint(0));
        sint far_at = half - near_at;
        pointer<const float> plane = low + step * k;
        vfloat near = load_broadcast(plane + near_at);
        vfloat far = load_broadcast(plane + far_at);
        vfloat enter = fma(near, rays.inverse[k], rays.early[k]);
        vfloat leave = fma(far, rays.inverse[k], rays.late[k]);
        if constexpr (Mixed) {
            near = fma(near, rays.inverse[k], rays.late[k]);
            far = fma(far, rays.inverse[k], rays.early[k]);
            enter = min(enter, far);
            leave = max(leave, near);
        }
        i.enter = k == 0 ? enter : max(enter, i.enter);
        i.leave = k == 0 ? leave : min(leave, i.leave);
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
        vfloat inverse = scene.inverse[k];
        vfloat moved = load_broadcast(origin_at + k);
        vfloat rate = abs(inverse);
        vfloat wider = rate * vfloat(widen);
        rays.inverse[k] = inverse;
        rays.early[k] = fma(inverse, moved, scene.early[k]) - wider;
        rays.late[k] = fma(inverse, moved, scene.late[k]) + wider;
    }
    svec origin = load_svec(origin_at);
    sint shift = cells_shift(v.quads_u);
    sint cells = ((v.quads_v + 1) >> 1) << shift;
    for (sint from = 0; branch(from < cells); from += isa::width) {
        vmask valid = first_lanes(cells - from);
        vmask met = boxes_met(g, v.words + (v.cells_at + from), cell_boxes, origin, widen, g.beam.begin,
                              g.beam.end, valid);
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
        Kept kept = find_blended(c, number, listed.line, listed.level);
        pointer<float> slot = kept.slot;
        if (branch(!kept.there)) {
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
            slot = keep_blended(c, seen, number, listed.line, listed.level, slot, [&](pointer<float> made) {
                if constexpr (F.hanging)
                    find_longest_edges(c, seen, v, header, made);
            });
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
    Slabs rays = load_slabs(c);
    tally(c.counters->box_tests, 1);
    Interval inside = box_interval<Mixed>(g, rays, listed.box, listed.box_step);
    vfloat enter = max(inside.enter, cell.enter);
    vmask in_cell = g.alive & (enter <= min(inside.leave, cell.leave));
    if (branch(none(in_cell)))
        return false;
    enter = max(inside.enter, g.t_min);
    vmask met = g.alive & (enter <= min(inside.leave, hits.t));
    if (branch(none(met)))
        return true;
    if (branch(g.leaves)) {
        vint left = load_vector(as<std::int32_t>(c.packets + packet_block_left));
        met = met & (left != vint(listed.line));
        if (branch(none(met)))
            return true;
    }
    tally(c.counters->block_tests, 1);
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + listed.line);
    ensure_made(c, header);
    sint instance = load(field(header, &BlockHeader::instance));
    pointer<float> origin_at = field(c.instances + instance, &InstanceRecord::origin);
    View v;
    v.line = listed.line;
    v.words = as<float>(header);
    v.patch = load(field(header, &BlockHeader::patch));
    v.number = load(field(header, &BlockHeader::number));
    sint triangles = load(field(header, &BlockHeader::triangles));
    v.triangles = triangles_in(triangles);
    v.from = seen_from(triangles);
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
        sint corners_at = load(field(header, &BlockHeader::corners_at));
        if (branch(g.morphs & (corners_at != no_vertex_moves))) {
            svec origin = load_svec(origin_at);
            pointer<float> box = field(header, &BlockHeader::box_low);
            if (branch(v.ancestors_at != 0))
                box = v.words + (v.ancestors_at + ancestor_box);
            svec low = load_svec(box) + origin;
            svec high = load_svec(box + 3) + origin;
            sint absolute = load(field(header, &BlockHeader::absolute));
            sfloat begin = moving_from(absolute);
            sbool some = most_target_in(g.fields, low, high, g.slack) > begin;
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
