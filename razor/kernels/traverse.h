// Packets through the kd-tree. A packet is traversed in groups of rays whose directions are long along one
// axis, so that order and projection are uniform; splitting by their signs as well, or by the
// octave of what the rays ask for, was measured to cost time (a tenth to a third; up to a tenth). A hit
// anywhere in a block counts, whatever cell led to it; a cell's exit, rounded outward, only ends traversal;
// equal distances go to the lowest (patch, triangle).
#pragma once

#include "razor/kernels/beam.h"
#include "razor/kernels/chain.h"
#include "razor/kernels/paper_levels.h"
#include "razor/kernels/patch_levels.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

/// 1/d, with directions too small to invert replaced by a tiny one of the same sign.
inline vfloat safe_inverse(const vfloat& d) {
    vint sign = as_int(d) & vint(std::int32_t(0x80000000U));
    vfloat tiny = as_float(sign | as_int(vfloat(1.0e-18F)));
    vmask usable = abs(d) > vfloat(1.0e-18F);
    return reciprocal(select(usable, d, tiny));
}

/// Slack of positions: by so much wider are the boxes that rays are tested with, so that no ray passes beside
/// the box of a triangle that it meets. Both tests round; vertices have no part in that, being the same bits
/// in both. In units of u, of a ray whose origin is (X, Z) from a vertex, across and along its group's axis,
/// X^2 + Z^2 <= R^2, and R no less than the distance of any two points of scene and camera:
///   the triangle's test (project()): the origin moved to the instance's coordinates R; x - ox: X; z - oz,
///   times the shear s = dx / dz, |s| <= 2: 2 Z; s itself: 2 Z; on sse4 the product: 2 Z; their difference,
///   no larger than |X| + 2 |Z| <= sqrt(5) R: 2.24 R;
///   the box's test, as no coordinate is beyond R: o / d: R; 1 / d: X; o / d and the slack: R; where boxes
///   are in coordinates of a mesh, its origin / d on sse4: R, that and o / d: R, that and what boxes are
///   widened by: R; the plane / d on sse4: R; the sum: X.
/// In all 3 X + 6 Z + 9.24 R <= (sqrt(3^2 + 6^2) + 9.24) R < 16 R; terms of u^2 are far below the rest.
inline sfloat position_slack(const Context& c) {
    sfloat reach = load(field(c.frame, &FrameHeader::reach));
    return reach * (16.0F * unit_roundoff);
}

/// Rays of a group have a component along its axis of at least this share of their largest. Any but 0 is
/// watertight; the smaller, the more rays go together and the more their vertices are sheared (by 2 here).
inline constexpr float least_component = 0.5F;

inline vint largest_component(const vvec& d) {
    vfloat ax = abs(d.x);
    vfloat ay = abs(d.y);
    vfloat az = abs(d.z);
    vmask y = ay > ax;
    vint axis = select(y, vint(1), vint(0));
    vmask z = az > max(ax, ay);
    return select(z, vint(2), axis);
}

inline vint sign_bits(const vvec& d) {
    vint x = shift_right_logical(as_int(d.x), 31);
    vint y = shift_right_logical(as_int(d.y), 30) & vint(2);
    vint z = shift_right_logical(as_int(d.z), 29) & vint(4);
    vint xy = x | y;
    return xy | z;
}

/// Everything common to the rays `alive`, which are sheared along axis `along`; `signs` are the first one's.
inline Group make_group(const Context& c, const Rays& r, vmask alive, sint along, sint signs) {
    Group g;
    g.alive = alive;
    g.kz = along;
    sbool last = g.kz == 2;
    g.kx = select(last, sint(0), g.kz + 1);
    last = g.kx == 2;
    g.ky = select(last, sint(0), g.kx + 1);
    vfloat dx = r.direction.y;
    vfloat dy = r.direction.z;
    vfloat dz = r.direction.x;
    g.ox = r.origin.y;
    g.oy = r.origin.z;
    g.oz = r.origin.x;
    if (branch(g.kz == 1)) {
        dx = r.direction.z;
        dy = r.direction.x;
        dz = r.direction.y;
        g.ox = r.origin.z;
        g.oy = r.origin.x;
        g.oz = r.origin.y;
    }
    if (branch(g.kz == 2)) {
        dx = r.direction.x;
        dy = r.direction.y;
        dz = r.direction.z;
        g.ox = r.origin.x;
        g.oy = r.origin.y;
        g.oz = r.origin.z;
    }
    g.scale_z = reciprocal(dz);
    g.shear_x = dx * g.scale_z;
    g.shear_y = dy * g.scale_z;
    g.t_min = r.t_min;

    sfloat slack = position_slack(c);
    g.slack = slack;
    g.morphs = load(field(c.frame, &FrameHeader::morphs)) != 0;
    const vfloat* origins[3] = {&r.origin.x, &r.origin.y, &r.origin.z};
    const vfloat* directions[3] = {&r.direction.x, &r.direction.y, &r.direction.z};
    for (int k = 0; k < 3; ++k) {
        vfloat inverse = safe_inverse(*directions[k]);
        vfloat passed = *origins[k] * inverse; // since coordinate 0
        vfloat rate = abs(inverse);
        vfloat error = rate * vfloat(slack);
        store_vector(c.packets + (packet_inverse + k * isa::width), inverse);
        store_vector(c.packets + (packet_early + k * isa::width), -passed - error);
        store_vector(c.packets + (packet_late + k * isa::width), error - passed);
        g.sign[k] = (signs >> k) & 1;
        vmask other = as_int(inverse) < vint(0);
        other = other ^ vmask(g.sign[k] != 0);
        g.mixed[k] = any(alive & other);
    }
    return g;
}

/// Distances at which the rays enter and leave the tree's box, widened by the slack.
inline void clip_to_tree(const Context& c, const Rays& r, vfloat& enter, vfloat& leave) {
    enter = r.t_min;
    leave = r.t_max;
    for (int k = 0; k < 3; ++k) {
        vfloat inverse = load_vector(c.packets + (packet_inverse + k * isa::width));
        vfloat early = load_vector(c.packets + (packet_early + k * isa::width));
        vfloat late = load_vector(c.packets + (packet_late + k * isa::width));
        vfloat low = load_broadcast(field(c.tree, &TreeRecord::low) + k);
        vfloat high = load_broadcast(field(c.tree, &TreeRecord::high) + k);
        vfloat at_low = fma(low, inverse, early);
        vfloat at_high = fma(high, inverse, early);
        enter = max(min(at_low, at_high), enter);
        at_low = fma(low, inverse, late);
        at_high = fma(high, inverse, late);
        leave = min(max(at_low, at_high), leave);
    }
}

/// The blocks of a leaf that is fine enough for the rays `here`, wherever these are: one that all have met is
/// in the mailbox. So a ray may meet a coarse block where alone it would have met finer ones that lie on it
/// but for rounding, or the reverse: last bits of a hit, and which block it names, depend on the packet.
/// Rays that only took hits within their own cells would not: that was measured to cost a quarter or more
/// of the time. AnyHit: a hit retires its lane from the group.
template <Features F, bool AnyHit, bool Mixed>
inline void intersect_leaf(const Context& c, Group& g, pointer<ItemList> list, vmask here,
                           const Interval& cell, Hits& hits) {
    pointer<std::int32_t> mailbox = as<std::int32_t>(c.stack + scratch_mailbox);
    vmask others = g.alive & !here;
    sbool everyone = none(others);
    if constexpr (F.hanging) {
        // Boxes here hold what rays up to `most` see. Others, elsewhere, may see a block outside its box:
        // they have not met it.
        sfloat most = load(field(list, &ItemList::most));
        sbool bounded = g.morphs & everyone;
        bounded = bounded & (most < unbounded_target);
        if (branch(bounded)) {
            svec low = load_svec(field(list, &ItemList::low));
            svec high = load_svec(field(list, &ItemList::high));
            everyone = most_target_in(g.fields, low, high, g.slack) <= most;
        }
    }
    sint n = load(field(list, &ItemList::in_cell));
    sint stride = load(field(list, &ItemList::stride));
    pointer<float> words = as<float>(list) + item_list_words;
    pointer<std::int32_t> items = as<std::int32_t>(words);
    Listed listed;
    listed.box_step = stride;
    listed.level = load(field(list, &ItemList::level));
    svec nowhere{sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
    for (sint from = 0; branch(from < n); from += isa::width) {
        vmask valid = first_lanes(n - from);
        vmask met = boxes_met(g, words + (stride + from), stride, nowhere, 0.0F, g.begin, g.end, valid);
        for (; branch(any(met)); met = clear_first(met)) {
            sint i = from + first(met);
            sint item = load(items + i);
            listed.line = sint(-1) - item;
            // Whoever finds a block in the mailbox knows that all rays still alive have met it.
            sint slot = (listed.line >> 2) & (mailbox_slots - 1);
            sint seen = load(mailbox + slot);
            if (branch(seen == listed.line))
                continue;
            listed.box = words + stride + i;
            g.alive = here;
            sbool tested = intersect_block<F, Mixed>(c, g, listed, cell, hits);
            if (branch(everyone & tested))
                store(mailbox + slot, listed.line);
            if constexpr (AnyHit) {
                vmask hit = hits.patch >= vint(0);
                here = here & !hit;
                hits.t = select(hit, vfloat(-infinite), hits.t);
            }
        }
    }
    g.alive = here | others;
}

/// One group from the root. AnyHit: the first hit retires a lane; its hit distance becomes -infinite.
template <Features F, LevelChoice By, bool AnyHit, bool Mixed>
[[gnu::noinline]] inline void trace_group(const Context& c, const Rays& r, Group g, Hits& hits) {
    phase_scope phase(phase_traverse);
    tally(c.counters->groups, 1);
    vfloat enter, leave;
    clip_to_tree(c, r, enter, leave);
    vfloat never(infinity);
    enter = select(g.alive, enter, never);
    vmask in_tree = enter <= leave;
    if (branch(none(in_tree)))
        return;
    find_beam(c, g, in_tree, enter, leave);
    pointer<std::int32_t> mailbox = as<std::int32_t>(c.stack + scratch_mailbox);
    for (int i = 0; i < mailbox_slots; i += isa::width)
        store_vector(mailbox + i, vint(-1), first_lanes(mailbox_slots - i));
    Scale scale;
    if constexpr (By == by_stretch)
        scale = scale_of_group(c, g, r);
    sint number = load(field(c.tree, &TreeRecord::root));
    pointer<float> top = c.stack; // of the stack: the next free entry
    sint depth = 0;
    [[maybe_unused]] Chain chain;
    for (;;) {
        tally(c.counters->node_visits, 1);
        pointer<KdNode> node = c.nodes + number;
        sint state = load_acquire(field(node, &KdNode::state));
        if (branch(state < node_inner))
            state = split_node(c, node, state);
        sint link = load(field(node, &KdNode::link));
        if (branch(state == node_inner)) {
            sint axis = load(field(node, &KdNode::axis));
            sfloat split = load(field(node, &KdNode::split));
            // Is all of the beam on one side?
            BeamSide side = side_of_beam(c, g, axis, split);
            if (branch(side.high)) {
                number = link + 1;
                continue;
            }
            if (branch(side.low)) {
                number = link;
                continue;
            }
            CutBeam cut = cut_beam(g, axis, split);
            vfloat plane(split);
            pointer<float> along = c.packets + axis * isa::width;
            vfloat inverse = load_vector(along + packet_inverse);
            vfloat early = load_vector(along + packet_early);
            vfloat late = load_vector(along + packet_late);
            early = fma(plane, inverse, early);
            late = fma(plane, inverse, late);
            vmask inside = enter <= leave;
            sint sign = select(axis == 1, g.sign[1], g.sign[2]);
            sign = select(axis == 0, g.sign[0], sign);
            sint near = link + sign;
            sint far = link + (sint(1) - sign);
            // What is near for the first ray comes first; for rays that run the other way the two are
            // swapped.
            vmask to_near = inside & (enter <= late);
            vmask to_far = inside & (leave >= early);
            vfloat near_enter = enter;
            vfloat near_leave = min(late, leave);
            vfloat far_enter = max(early, enter);
            if constexpr (Mixed) {
                vmask other = as_int(inverse) < vint(0);
                other = other ^ vmask(sign != 0);
                vmask swapped = (to_near ^ to_far) & other;
                to_near = to_near ^ swapped;
                to_far = to_far ^ swapped;
                vfloat near_leave_other = select(other, leave, near_leave);
                leave = select(other, near_leave, leave);
                near_leave = near_leave_other;
                near_enter = select(other, far_enter, enter);
                far_enter = select(other, enter, far_enter);
            }
            sbool high_first = sign != 0;
            if (branch(none(to_far))) {
                number = near;
                enter = select(to_near, near_enter, never);
                leave = near_leave;
                clip_beam(g, cut, high_first);
                continue;
            }
            far_enter = select(to_far, far_enter, never);
            if (branch(none(to_near))) {
                number = far;
                enter = far_enter;
                clip_beam(g, cut, sign == 0);
                continue;
            }
            store(as<std::int32_t>(top), far);
            store(top + 1, select(high_first, g.begin, cut.high_begin));
            store(top + 2, select(high_first, cut.low_end, g.end));
            store_vector(top + 16, far_enter);
            store_vector(top + (16 + isa::width), leave);
            top = top + stack_entry;
            ++depth;
            number = near;
            enter = select(to_near, near_enter, never);
            leave = near_leave;
            clip_beam(g, cut, high_first);
            continue;
        }
        if (branch(link >= 0)) {
            pointer<ItemList> list = as<ItemList>(c.lists + link);
            sint finer = load(field(list, &ItemList::finer));
            vmask deeper = vmask(false);
            if constexpr (F.hanging && By == by_leaf) {
                if (branch(finer >= 0)) {
                    sfloat coarse = load(field(list, &ItemList::coarse));
                    svec low = load_svec(field(list, &ItemList::low));
                    svec high = load_svec(field(list, &ItemList::high));
                    sfloat least = least_target_in(g.fields, low, high, g.slack);
                    if (branch(least < coarse)) {
                        sint far = node_beyond(c, g, list, coarse, least);
                        if (branch(far >= 0)) {
                            walk(chain, list, link, number, far);
                            number = far;
                            continue;
                        }
                        // Where this is too coarse for a ray, all go on in the same cell, if what is finer is
                        // bounded for what they ask: nobody is left behind, who would keep it from the
                        // mailbox.
                        sfloat bound = load(field(list, &ItemList::coarsest));
                        if (branch(most_target_in(g.fields, low, high, g.slack) <= bound)) {
                            sint levels = walk(chain, list, link, number, finer);
                            keep_beyond(c, chain, link, levels);
                            number = finer;
                            continue;
                        }
                        Targets t = targets_in(c, g.fields, low, high, g.slack);
                        deeper = g.alive & (t.least < vfloat(coarse));
                        // Those that are elsewhere keep nobody here.
                        vmask staying = g.alive & !deeper;
                        if (branch(none(staying & (enter <= leave)))) {
                            number = finer;
                            continue;
                        }
                    }
                }
            }
            if constexpr (By != by_leaf) {
                if constexpr (By == by_patch)
                    deeper = intersect_patches<F, AnyHit, Mixed>(c, g, list, {enter, leave}, hits);
                else
                    deeper = intersect_stretches<F, AnyHit, Mixed>(c, g, scale, list, {enter, leave}, hits);
                if constexpr (AnyHit) {
                    if (branch(none(g.alive)))
                        return;
                }
            } else {
                vmask here = g.alive & !deeper;
                if (branch(any(here))) {
                    intersect_leaf<F, AnyHit, Mixed>(c, g, list, here, {enter, leave}, hits);
                    deeper = deeper & g.alive;
                    if constexpr (AnyHit) {
                        if (branch(none(g.alive)))
                            return;
                    }
                }
            }
            if constexpr (F.hanging) {
                // Those for which this is too coarse go on in the same cell.
                leave = min(hits.t, leave);
                vmask inside = deeper & (enter <= leave);
                if (branch(any(inside))) {
                    number = finer;
                    enter = select(deeper, enter, never);
                    continue;
                }
            }
        }
        for (;;) {
            if (branch(depth == 0))
                return;
            --depth;
            top = top + -stack_entry;
            number = load(as<std::int32_t>(top));
            g.begin = load(top + 1);
            g.end = load(top + 2);
            enter = load_vector(top + 16);
            leave = load_vector(top + (16 + isa::width));
            leave = min(hits.t, leave);
            if (branch(any(enter <= leave)))
                break;
        }
    }
}

/// Rays that have a defined answer: finite, a direction, a range that is not empty.
inline vmask usable_rays(const Rays& r) {
    vfloat size = abs(r.origin.x);
    size = size + abs(r.origin.y);
    size = size + abs(r.origin.z);
    vmask ok = r.active & (size < vfloat(infinite));
    vfloat square = dot(r.direction, r.direction);
    ok = ok & (square > vfloat(0.5F));
    ok = ok & (square < vfloat(2.0F));
    return ok & (r.t_min <= r.t_max);
}

inline Hits no_hits(const Rays& r) {
    Hits h;
    h.t = r.t_max;
    h.u = vfloat(0.0F);
    h.v = vfloat(0.0F);
    h.patch = vint(-1);
    h.triangle = vint(-1);
    h.block = vint(-1);
    h.field = vint(-1);
    return h;
}

inline void bound_component(const vfloat& v, const vmask& m, sfloat& least, sfloat& most) {
    vfloat far(infinite);
    least = reduce_min(select(m, v, far));
    most = reduce_max(select(m, v, -far));
}

inline FieldBounds bound_fields(const Rays& r, const vmask& m) {
    FieldBounds f;
    bound_component(r.field_origin.x, m, f.low.x, f.high.x);
    bound_component(r.field_origin.y, m, f.low.y, f.high.y);
    bound_component(r.field_origin.z, m, f.low.z, f.high.z);
    bound_component(r.slope.x * level_rounding, m, f.least_slope.x, f.most_slope.x);
    bound_component(r.slope.y * level_rounding, m, f.least_slope.y, f.most_slope.y);
    bound_component(r.slope.z * level_rounding, m, f.least_slope.z, f.most_slope.z);
    vmask flat = r.slope.x == vfloat(0.0F);
    flat = flat & (r.slope.y == vfloat(0.0F));
    flat = flat & (r.slope.z == vfloat(0.0F));
    f.sloped = any(m & !flat);
    bound_component(r.radius, m, f.least_radius, f.most_radius);
    bound_component(r.base * level_rounding, m, f.least_base, f.most_base);
    bound_component(r.growth * level_rounding, m, f.least_growth, f.most_growth);
    svec apart = f.high - f.low;
    f.spread = sqrt(dot(apart, apart)) + f.most_radius;
    f.spread = f.spread - f.least_radius;
    return f;
}

inline void store_fields(const Context& c, const Rays& r) {
    pointer<float> at = c.packets + packet_field;
    store_vector(at, r.field_origin.x);
    store_vector(at + isa::width, r.field_origin.y);
    store_vector(at + 2 * isa::width, r.field_origin.z);
    store_vector(at + 3 * isa::width, r.radius);
    store_vector(at + 4 * isa::width, r.base * level_rounding);
    store_vector(at + 5 * isa::width, r.growth * level_rounding);
    store_vector(at + 6 * isa::width, r.slope.x * level_rounding);
    store_vector(at + 7 * isa::width, r.slope.y * level_rounding);
    store_vector(at + 8 * isa::width, r.slope.z * level_rounding);
    store_vector(as<std::int32_t>(c.packets + packet_number), r.number);
}

template <Features F, LevelChoice By, bool AnyHit>
inline void trace_either(const Context& c, const Rays& r, const Group& g, Hits& hits) {
    sbool mixed = g.mixed[0] | g.mixed[1];
    mixed = mixed | g.mixed[2];
    if (branch(mixed))
        trace_group<F, By, AnyHit, true>(c, r, g, hits);
    else
        trace_group<F, By, AnyHit, false>(c, r, g, hits);
}

/// Traces a packet; the hits of lanes that hit something name a patch.
template <Features F, bool AnyHit> [[gnu::noinline]] inline Hits trace(const Context& c, const Rays& r) {
    phase_scope phase(phase_traverse);
    ensure_root(c);
    FieldBounds fields;
    sint choice = sint(by_leaf);
    if constexpr (F.hanging) {
        choice = load(field(c.frame, &FrameHeader::level_choice));
        store_fields(c, r);
        fields = bound_fields(r, usable_rays(r));
    }
    sbool leaves = any(r.left >= vint(0));
    store_vector(as<std::int32_t>(c.packets + packet_block_left), r.left);
    Hits hits = no_hits(r);
    vint axis = largest_component(r.direction);
    vfloat least = largest(abs(r.direction)) * least_component;
    vint signs = sign_bits(r.direction);
    vmask left = usable_rays(r);
    while (branch(any(left))) {
        sint one = first(left);
        sint along = extract(axis, one);
        vmask x = vmask(along == 0);
        vmask y = vmask(along == 1);
        vfloat component = select(x, r.direction.x, select(y, r.direction.y, r.direction.z));
        vmask same = left & (abs(component) >= least);
        left = left & !same;
        Group g = make_group(c, r, same, along, extract(signs, one));
        g.fields = fields;
        g.leaves = leaves;
        if constexpr (F.hanging) {
            if (branch(choice == sint(by_patch))) {
                trace_either<F, by_patch, AnyHit>(c, r, g, hits);
                continue;
            }
            if (branch(choice == sint(by_stretch))) {
                trace_either<F, by_stretch, AnyHit>(c, r, g, hits);
                continue;
            }
        }
        trace_either<F, by_leaf, AnyHit>(c, r, g, hits);
    }
    return hits;
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
