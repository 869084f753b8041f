// Packets through the kd-tree. A packet is traversed in groups of rays whose directions agree in signs and in
// largest component, so that order and projection are uniform. A hit anywhere in a block counts, whatever
// cell led to it; a cell's exit, rounded outward, only ends traversal; equal distances go to the lowest
// (patch, triangle).
#pragma once

#include "razor/kernels/intersect.h"

#include <limits>

namespace razor::ISA_TARGET {

inline constexpr float infinite =
    3.0e38F; // distances beyond every scene, whose sums and products stay finite enough

/// 1/d, with directions too small to invert replaced by a tiny one of the same sign.
inline vfloat safe_inverse(const vfloat& d) {
    vint sign = as_int(d) & vint(std::int32_t(0x80000000U));
    vfloat tiny = as_float(sign | as_int(vfloat(1.0e-18F)));
    vmask usable = abs(d) > vfloat(1.0e-18F);
    return reciprocal(select(usable, d, tiny));
}

/// Slack of positions: a bound on the rounding of everything between a vertex and a plane's distance, for
/// coordinates up to `reach` (a dozen roundings of half an ulp each).
inline sfloat position_slack(const Context& c) {
    sfloat reach = load(field(c.frame, &FrameHeader::reach));
    return reach * (12.0F / 16777216.0F);
}

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

/// Everything uniform about the rays `alive`, which share direction class `direction_class` (axis * 8 + sign
/// bits).
inline Group make_group(const Context& c, const Rays& r, vmask alive, sint direction_class) {
    Group g;
    g.alive = alive;
    g.kz = direction_class >> 3;
    g.kx = select(g.kz == 2, sint(0), g.kz + 1);
    g.ky = select(g.kx == 2, sint(0), g.kx + 1);
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
    vfloat far_away(infinite);
    g.first_t = reduce_min(select(alive, r.t_min, far_away));

    sfloat slack = position_slack(c);
    const vfloat* origins[3] = {&r.origin.x, &r.origin.y, &r.origin.z};
    const vfloat* directions[3] = {&r.direction.x, &r.direction.y, &r.direction.z};
    for (int k = 0; k < 3; ++k) {
        vfloat o = *origins[k];
        vfloat inverse = safe_inverse(*directions[k]);
        vfloat rate = abs(inverse);
        store_vector(c.packets + (packet_origin + k * isa::width), o);
        store_vector(c.packets + (packet_inverse + k * isa::width), inverse);
        store_vector(c.packets + (packet_error + k * isa::width), rate * vfloat(slack));
        g.sign[k] = (direction_class >> k) & 1;
        sfloat least_o = reduce_min(select(alive, o, far_away));
        sfloat most_o = reduce_max(select(alive, o, vfloat(-infinite)));
        sbool negative = g.sign[k] != 0;
        g.flip[k] = select(negative, sfloat(-1.0F), sfloat(1.0F));
        g.near[k] = select(negative, -least_o, most_o) + slack;
        sfloat exit = select(negative, -most_o, least_o);
        g.far[k] = exit - slack;
        g.least[k] = reduce_min(select(alive, rate, far_away));
        g.most[k] = reduce_max(select(alive, rate, vfloat(0.0F)));
    }
    return g;
}

/// Distances at which the rays enter and leave the tree's box, widened by the slack.
inline void clip_to_tree(const Context& c, const Rays& r, vfloat& enter, vfloat& leave) {
    enter = r.t_min;
    leave = r.t_max;
    for (int k = 0; k < 3; ++k) {
        vfloat o = load_vector(c.packets + (packet_origin + k * isa::width));
        vfloat inverse = load_vector(c.packets + (packet_inverse + k * isa::width));
        vfloat error = load_vector(c.packets + (packet_error + k * isa::width));
        vfloat low = load_broadcast(field(c.tree, &TreeRecord::low) + k);
        vfloat high = load_broadcast(field(c.tree, &TreeRecord::high) + k);
        low = (low - o) * inverse;
        high = (high - o) * inverse;
        enter = max(min(low, high) - error, enter);
        leave = min(max(low, high) + error, leave);
    }
}

/// One group from the root. AnyHit: the first hit retires a lane; its hit distance becomes -infinite.
template <Features F, bool AnyHit>
inline void trace_group(const Context& c, const Rays& r, Group g, Hits& hits) {
    phase_scope phase(phase_traverse);
    tally(c.counters->groups, 1);
    vfloat enter, leave;
    clip_to_tree(c, r, enter, leave);
    vfloat never(std::numeric_limits<float>::infinity());
    enter = select(g.alive, enter, never);
    pointer<std::int32_t> mailbox = as<std::int32_t>(c.stack + scratch_mailbox);
    for (int i = 0; i < mailbox_slots; i += isa::width)
        store_vector(mailbox + i, vint(-1), first_lanes(mailbox_slots - i));
    sint number = load(field(c.tree, &TreeRecord::root));
    pointer<float> top = c.stack; // of the stack: the next free entry
    sint depth = 0;
    for (;;) {
        tally(c.counters->node_visits, 1);
        pointer<KdNode> node = c.nodes + number;
        sint state = load_acquire(field(node, &KdNode::state));
        if (branch(state < node_inner))
            state = split_node(c, node, state);
        sint link = load(field(node, &KdNode::link));
        if (branch(state == node_inner)) {
            sint axis = load(field(node, &KdNode::axis));
            vfloat plane = load_broadcast(field(node, &KdNode::split));
            pointer<float> along = c.packets + axis * isa::width;
            vfloat o = load_vector(along + packet_origin);
            vfloat inverse = load_vector(along + packet_inverse);
            vfloat error = load_vector(along + packet_error);
            vfloat t = (plane - o) * inverse;
            vfloat early = t - error;
            vfloat late = t + error;
            vmask inside = enter <= leave;
            vmask to_near = inside & (enter <= late);
            vmask to_far = inside & (leave >= early);
            sint sign = select(axis == 0, g.sign[0], select(axis == 1, g.sign[1], g.sign[2]));
            sint near = link + sign;
            if (branch(none(to_far))) {
                number = near;
                enter = select(to_near, enter, never);
                leave = min(late, leave);
                continue;
            }
            vfloat far_enter = select(to_far, max(early, enter), never);
            sint far = link + (sint(1) - sign);
            if (branch(none(to_near))) {
                number = far;
                enter = far_enter;
                continue;
            }
            store(as<std::int32_t>(top), far);
            store_vector(top + 16, far_enter);
            store_vector(top + (16 + isa::width), leave);
            top = top + stack_entry;
            ++depth;
            number = near;
            enter = select(to_near, enter, never);
            leave = min(late, leave);
            continue;
        }
        pointer<ItemList> list = as<ItemList>(c.lists + link);
        sint n = load(field(list, &ItemList::count));
        pointer<std::int32_t> items = as<std::int32_t>(as<float>(list) + item_list_words);
        for (sint i = 0; branch(i < n); ++i) {
            sint item = load(items + i);
            sint line = sint(-1) - item;
            sint slot = (line >> 2) & (mailbox_slots - 1);
            sint seen = load(mailbox + slot);
            if (branch(seen != line)) {
                store(mailbox + slot, line);
                intersect_block<F>(c, g, line, hits);
                if constexpr (AnyHit) {
                    vmask hit = hits.patch >= vint(0);
                    g.alive = g.alive & !hit;
                    hits.t = select(hit, vfloat(-infinite), hits.t);
                }
            }
        }
        if constexpr (AnyHit) {
            if (branch(none(g.alive)))
                return;
        }
        for (;;) {
            if (branch(depth == 0))
                return;
            --depth;
            top = top + -stack_entry;
            number = load(as<std::int32_t>(top));
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
    return h;
}

/// Traces a packet; the hits of lanes that hit something name a patch.
template <Features F, bool AnyHit> inline Hits trace(const Context& c, const Rays& r) {
    ensure_root(c);
    Hits hits = no_hits(r);
    vint axis = largest_component(r.direction);
    vint direction_class = sign_bits(r.direction);
    direction_class = direction_class | (axis << 3);
    vmask left = usable_rays(r);
    while (branch(any(left))) {
        sint one = extract(direction_class, first(left));
        vmask same = left & (direction_class == vint(one));
        left = left & !same;
        Group g = make_group(c, r, same, one);
        trace_group<F, AnyHit>(c, r, g, hits);
    }
    return hits;
}

} // namespace razor::ISA_TARGET
