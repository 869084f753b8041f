// Rays against blocks in the paper's scheme (paper_scale.h). Along a ray one pair of levels follows the
// other; hits beyond the stretch of their own pair do not count, and what hangs from a longer edge is not
// closed: rays may pass where one pair hands over to the next, and beside hanging vertices.
#pragma once

#include "razor/kernels/intersect.h"
#include "razor/kernels/paper_scale.h"

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

inline constexpr int no_pair = 1024; // or its opposite: beyond all that floats can tell

/// A block between levels `pair` and pair + 1, each vertex where the group's rays see it.
struct PairView : View {
    pointer<float> coarse_x, coarse_y, coarse_z;
    Scale scale; // permuted as the group
    sint pair;
    sint below, above; // pairs further down, or up, are as these are: nothing is finer, or coarser
    sbool moving;      // or all weights are 1
};

[[gnu::always_inline]] inline Projected project_vertex(const Group& g, const PairView& v, sint i) {
    vvec p;
    p.x = load_broadcast(v.x + i);
    p.y = load_broadcast(v.y + i);
    p.z = load_broadcast(v.z + i);
    if (branch(v.moving)) {
        vvec from_ray{p.x - v.ox, p.y - v.oy, p.z - v.oz};
        vfloat weight = pair_weight(v.scale, dot(from_ray, v.scale.direction), v.pair);
        vvec coarse;
        coarse.x = load_broadcast(v.coarse_x + i);
        coarse.y = load_broadcast(v.coarse_y + i);
        coarse.z = load_broadcast(v.coarse_z + i);
        p = blend_pair(weight, p, coarse);
    }
    return project(g, v, p.x, p.y, p.z);
}

/// The scale of the group's rays, directions permuted as the group.
inline Scale scale_of_group(const Context& c, const Group& g, const Rays& r) {
    Scale s = scale_of(c, r);
    if (branch(g.kz == 0))
        s.direction = {r.direction.y, r.direction.z, r.direction.x};
    if (branch(g.kz == 1))
        s.direction = {r.direction.z, r.direction.x, r.direction.y};
    return s;
}

/// The pair that serves where `target` is asked for.
inline vint serving_pair(const PairView& v, const vfloat& target) {
    vint pair = pair_of(target);
    pair = max(pair, vint(v.below));
    return min(pair, vint(v.above));
}

/// Hits in the stretch of the pair.
inline vmask counted(const PairView& v, const vmask& hit, const vfloat& t) {
    vint pair = serving_pair(v, target_along(v.scale, t));
    return hit & (pair == vint(v.pair));
}

/// Lanes to which all vertices in the listed box are at their finer place: no ray asks there, beside where it
/// passes, for more than what level k begins to move at.
inline vmask see_fine(const Group& g, const Scale& s, const Listed& listed, sint k) {
    pointer<const float> low = listed.box;
    sint step = listed.box_step;
    pointer<const float> high = low + step * 3;
    sint axes[3] = {g.kx, g.ky, g.kz};
    const vfloat* origins[3] = {&g.ox, &g.oy, &g.oz};
    const vfloat* directions[3] = {&s.direction.x, &s.direction.y, &s.direction.z};
    vfloat least(0.0F);
    vfloat most(0.0F);
    for (int i = 0; i < 3; ++i) {
        vfloat a = load_broadcast(low + step * axes[i]);
        vfloat b = load_broadcast(high + step * axes[i]);
        a = (a - *origins[i]) * *directions[i];
        b = (b - *origins[i]) * *directions[i];
        least = least + min(a, b);
        most = most + max(a, b);
    }
    sfloat slack = g.slack * 4.0F;
    Asked asked = asked_between(s, least, most, slack);
    return asked.most <= vfloat(moving_from(k));
}

/// The block for the lanes `m`, which are in the stretch of the pair.
template <Features F, bool Mixed>
inline void intersect_pair(const Context& c, Group& g, PairView& v, const Listed& listed, const Slabs& rays,
                           const vmask& m, Hits& hits) {
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + v.line);
    sint instance = load(field(header, &BlockHeader::instance));
    pointer<float> origin_at = field(c.instances + instance, &InstanceRecord::origin);
    sint stride = load(field(header, &BlockHeader::stride));
    sint absolute = load(field(header, &BlockHeader::absolute));
    sint corners_at = load(field(header, &BlockHeader::corners_at));
    sbool moves = corners_at != no_vertex_moves;
    moves = moves & (v.pair >= absolute);
    pointer<float> block = as<float>(header);
    pointer<float> fine = block;
    sfloat sway = 0.0F;
    v.field = -1;
    if (branch(moves)) {
        sway = sway_of(c, header, gone_from(v.pair));
        if (branch(v.pair > absolute)) {
            fine = level_slot(c, v.pair, v.line) + slot_block;
            v.field = number_of_level(v.pair);
        }
    }
    set_vertices(g, v, stride, fine, origin_at);
    v.words = block; // for the cells, which are widened
    auto visit = [&](sint column, sint row) {
        tally(c.counters->cell_tests, 1);
        intersect_cell<F>(c, g, v, column, row, hits);
    };
    vmask still = m;
    if (branch(moves))
        still = m & see_fine(g, v.scale, listed, v.pair);
    if (branch(any(still))) {
        tally(c.counters->plain_tests, 1);
        g.alive = still;
        v.moving = false;
        visit_cells<Mixed>(g, v, rays, sway, origin_at, hits, visit);
    }
    vmask moved = m & !still;
    if (branch(any(moved))) {
        tally(c.counters->blended_tests, 1);
        g.alive = moved;
        v.moving = true;
        v.field = number_of_level(v.pair);
        pointer<float> coarse = level_slot(c, v.pair + 1, v.line) + (slot_block + block_header_words);
        v.coarse_x = coarse + stride * g.kx;
        v.coarse_y = coarse + stride * g.ky;
        v.coarse_z = coarse + stride * g.kz;
        visit_cells<Mixed>(g, v, rays, sway, origin_at, hits, visit);
    }
}

/// Rays of the group against a block listed by a leaf, in whatever pairs they are within the cell.
template <Features F, bool Mixed>
[[gnu::noinline]] inline void intersect_pairs(const Context& c, Group& g, const Scale& scale,
                                              const Listed& listed, const Interval& cell, Hits& hits) {
    phase_scope phase(phase_intersect);
    Slabs rays = load_slabs(c);
    tally(c.counters->box_tests, 1);
    Interval inside = box_interval<Mixed>(g, rays, listed.box, listed.box_step);
    vfloat enter = max(inside.enter, cell.enter);
    vfloat leave = min(inside.leave, cell.leave);
    leave = min(leave, hits.t);
    vmask met = g.alive & (enter <= leave);
    if (branch(none(met)))
        return;
    tally(c.counters->block_tests, 1);
    pointer<BlockHeader> header = as<BlockHeader>(c.grids + listed.line);
    ensure_made(c, header);
    PairView v;
    v.line = listed.line;
    v.patch = load(field(header, &BlockHeader::patch));
    v.number = load(field(header, &BlockHeader::number));
    sint triangles = load(field(header, &BlockHeader::triangles));
    v.triangles = triangles_in(triangles);
    v.from = seen_from(triangles);
    v.quads_u = load(field(header, &BlockHeader::quads_u));
    v.quads_v = load(field(header, &BlockHeader::quads_v));
    v.cells_at = load(field(header, &BlockHeader::cells_at));
    v.hangs = 0;
    v.scale = scale;
    sint level = load(field(header, &BlockHeader::level));
    sint absolute = load(field(header, &BlockHeader::absolute));
    sint parent = load(field(header, &BlockHeader::parent));
    sint corners_at = load(field(header, &BlockHeader::corners_at));
    // A block is of one pair, but where there is no finer or no coarser one. Below the finest level nothing
    // moves, nor above the one at which every curve is one segment.
    sint lowest = absolute;
    sint highest = absolute;
    v.below = -no_pair;
    v.above = no_pair;
    if (branch(level == 0)) {
        if (branch(corners_at != no_vertex_moves))
            lowest = absolute - 1;
        v.below = lowest;
    }
    if (branch(parent < 0)) {
        if (branch(corners_at != no_vertex_moves))
            highest = max(absolute - level + (max_exponent_limit + 1), absolute);
        v.above = highest;
    }
    Asked asked = asked_between(scale, enter, leave, g.slack);
    vint first_pair = serving_pair(v, asked.least);
    first_pair = max(first_pair, vint(lowest));
    vint last_pair = serving_pair(v, asked.most);
    last_pair = min(last_pair, vint(highest));
    vmask all = g.alive;
    vmask left = met & (first_pair <= last_pair);
    while (branch(any(left))) {
        v.pair = reduce_min(select(left, first_pair, vint(no_pair)));
        vmask now = left & (first_pair == vint(v.pair));
        intersect_pair<F, Mixed>(c, g, v, listed, rays, now, hits);
        first_pair = select(now, first_pair + vint(1), first_pair);
        left = left & (first_pair <= last_pair);
    }
    g.alive = all;
}

} // namespace intersect_kernel

inline namespace traverse_kernel {

/// The blocks of a leaf. Returns the rays that go on to finer ones: those that ask for such somewhere in the
/// cell. They meet here only the blocks that are made finer there; the others they find there again.
template <Features F, bool AnyHit, bool Mixed>
inline vmask intersect_stretches(const Context& c, Group& g, const Scale& scale, pointer<ItemList> list,
                                 const Interval& cell, Hits& hits) {
    vmask alive = g.alive;
    vmask inside = alive & (cell.enter <= cell.leave);
    vmask deeper = vmask(false);
    sint n = load(field(list, &ItemList::count));
    sint stride = load(field(list, &ItemList::stride));
    pointer<float> words = as<float>(list) + item_list_words;
    pointer<std::int32_t> items = as<std::int32_t>(words);
    Listed listed;
    listed.box_step = stride;
    listed.level = load(field(list, &ItemList::level));
    sint finer = load(field(list, &ItemList::finer));
    if (branch(finer >= 0)) {
        Asked asked = asked_between(scale, cell.enter, cell.leave, g.slack);
        vint least = pair_of(asked.least);
        deeper = inside & (least < vint(listed.level));
    }
    for (sint i = 0; branch(i < n); ++i) {
        sint item = load(items + i);
        listed.line = sint(-1) - item;
        listed.box = words + stride + i;
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + listed.line);
        sint level = load(field(block, &BlockHeader::level));
        sint absolute = load(field(block, &BlockHeader::absolute));
        sbool goes = absolute == listed.level;
        goes = goes & (level > 0);
        g.alive = inside & !deeper;
        if (branch(goes))
            g.alive = inside;
        if (branch(none(g.alive)))
            continue;
        intersect_pairs<F, Mixed>(c, g, scale, listed, cell, hits);
        if constexpr (AnyHit) {
            vmask hit = hits.patch >= vint(0);
            alive = alive & !hit;
            inside = inside & !hit;
            hits.t = select(hit, vfloat(-infinite), hits.t);
        }
    }
    g.alive = alive;
    return deeper & alive;
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
