// The kd-tree, split on demand by the surface-area heuristic: a node is split when the first ray enters it.
// Planes are sampled, 8 an axis and then 8 more around the best (after Hunt, Mark & Stoll 2006). The bonus
// for empty space ranks planes only: whether to split is asked of the cost, or piles would be trimmed for
// ever. The root lists the root of the scene graph. Graph nodes, instances, clusters and patches stay closed
// in the lists until their box is large against the node's cell (after Hunt et al. 2007), or no plane is
// worth its cost. A node of few blocks becomes a leaf of their level; rays for which that is too coarse go on
// to its finer node, whose list is made of the blocks' children and split in turn.
#pragma once

#include "razor/kernels/budget_use.h"
#include "razor/kernels/kd_open.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

inline constexpr int plane_samples = 8;
inline constexpr float traversal_cost = 1.0F; // a packet's visit to a node ...
// ... and its test of a block, of which a leaf tells many at once from those it misses ...
inline constexpr float block_cost = 0.25F;
// ... and of an item of a list in which some are closed: there leaves are opened whole, whatever of it rays
// meet.
inline constexpr float closed_cost = 1.5F;
inline constexpr float empty_bonus = 0.85F;
inline constexpr int few_items = 8;       // so few patches are opened whatever their size
inline constexpr float large_item = 0.5F; // of the cell's largest side

struct Plane {
    sfloat cost; // expected, of the node split here
    sfloat rank; // by which planes are compared: the cost, less the bonus where a side is empty
    sfloat at;
    sint axis;
    sint below, above; // items on either side
};

/// Counts the items on both sides of 8 planes between `from` and `to` (exclusive) and keeps the one of lowest
/// rank.
inline void try_planes(const List& l, sfloat item_cost, int axis, sfloat from, sfloat to, Plane& best) {
    sfloat lows[3] = {l.low.x, l.low.y, l.low.z};
    sfloat highs[3] = {l.high.x, l.high.y, l.high.z};
    sfloat low = lows[axis];
    sfloat high = highs[axis];
    sfloat e1 = highs[(axis + 1) % 3] - lows[(axis + 1) % 3];
    sfloat e2 = highs[(axis + 2) % 3] - lows[(axis + 2) % 3];
    sfloat step = (to - from) * (1.0F / (plane_samples + 1));
    vfloat at[plane_samples];
    sfloat place[plane_samples];
    sint below[plane_samples], above[plane_samples];
    for (int k = 0; k < plane_samples; ++k) {
        place[k] = fma(step, sfloat(static_cast<float>(k + 1)), from);
        at[k] = vfloat(place[k]);
        below[k] = 0;
        above[k] = 0;
    }
    pointer<float> item_low = l.boxes + l.stride * axis;
    pointer<float> item_high = l.boxes + l.stride * (axis + 3);
    for (sint i = 0; branch(i < l.count); i += isa::width) {
        vmask m = first_lanes(l.count - i);
        vfloat a = load_vector(item_low + i, m);
        vfloat b = load_vector(item_high + i, m);
        for (int k = 0; k < plane_samples; ++k) {
            below[k] += count(m & is_below(a, b, at[k]));
            above[k] += count(m & is_above(b, at[k]));
        }
    }
    sfloat side = e1 * e2;
    sfloat rim = e1 + e2;
    sfloat area = fma(high - low, rim, side);
    sfloat per_area = item_cost / area;
    for (int k = 0; k < plane_samples; ++k) {
        sfloat area_below = fma(place[k] - low, rim, side);
        sfloat area_above = fma(high - place[k], rim, side);
        sfloat weighted = area_below * to_float(below[k]);
        weighted = fma(area_above, to_float(above[k]), weighted);
        sfloat cost = fma(weighted, per_area, sfloat(traversal_cost));
        sbool empty = below[k] == 0;
        empty = empty | (above[k] == 0);
        sfloat rank = select(empty, cost * empty_bonus, cost);
        sbool better = rank < best.rank;
        better = better & (place[k] > low);
        better = better & (place[k] < high);
        if (branch(better)) {
            best.cost = cost;
            best.rank = rank;
            best.at = place[k];
            best.axis = axis;
            best.below = below[k];
            best.above = above[k];
        }
    }
}

/// The plane of lowest rank found; its cost stays infinite if none separates anything.
inline Plane choose_plane(const List& l, sfloat item_cost) {
    Plane best;
    best.cost = 3.0e38F;
    best.rank = 3.0e38F;
    best.axis = -1;
    sfloat lows[3] = {l.low.x, l.low.y, l.low.z};
    sfloat highs[3] = {l.high.x, l.high.y, l.high.z};
    for (int axis = 0; axis < 3; ++axis)
        try_planes(l, item_cost, axis, lows[axis], highs[axis], best);
    for (int axis = 0; axis < 3; ++axis) {
        if (branch(best.axis == axis)) {
            sfloat reach = (highs[axis] - lows[axis]) * (1.0F / (plane_samples + 1));
            sfloat from = best.at - reach;
            try_planes(l, item_cost, axis, from, best.at + reach, best);
            break;
        }
    }
    return best;
}

/// The list of a node below the one whose list is split; none if nothing is in it.
inline List begin_child(const Context& c, const List& parent, sint count, const svec& low, const svec& high) {
    if (branch(count > 0)) {
        List l = make_list(c, count, parent.depth + 1, parent.most, low, high);
        note_list_level_of(l, parent);
        return l;
    }
    List none = parent;
    none.count = 0;
    none.line = -1;
    return none;
}

/// Writes the items on either side of the plane into the lists of two new nodes; returns the lower one's
/// number.
inline sint split_list(const Context& c, const List& l, const Plane& plane) {
    sint children = allocate_nodes(c, 2);
    svec cut_high = l.high;
    svec cut_low = l.low;
    cut_high.x = select(plane.axis == 0, plane.at, l.high.x);
    cut_high.y = select(plane.axis == 1, plane.at, l.high.y);
    cut_high.z = select(plane.axis == 2, plane.at, l.high.z);
    cut_low.x = select(plane.axis == 0, plane.at, l.low.x);
    cut_low.y = select(plane.axis == 1, plane.at, l.low.y);
    cut_low.z = select(plane.axis == 2, plane.at, l.low.z);
    List child[2];
    child[0] = begin_child(c, l, plane.below, l.low, cut_high);
    child[1] = begin_child(c, l, plane.above, cut_low, l.high);
    sint at[2] = {0, 0};
    pointer<float> low = l.boxes + l.stride * plane.axis;
    pointer<float> high = low + l.stride * 3;
    vfloat where = vfloat(plane.at);
    for (sint i = 0; branch(i < l.count); i += isa::width) {
        vmask m = first_lanes(l.count - i);
        Items v = load_items(l, i, m);
        vfloat a = load_vector(low + i, m);
        vfloat b = load_vector(high + i, m);
        at[0] = append(child[0], at[0], v, m & is_below(a, b, where));
        at[1] = append(child[1], at[1], v, m & is_above(b, where));
    }
    for (int k = 0; k < 2; ++k) {
        pointer<KdNode> node = c.nodes + (children + k);
        note_level_of(node, 1, l.header);
        sbool empty = child[k].count == 0;
        if (branch(!empty))
            close_list(child[k]);
        store(field(node, &KdNode::link), child[k].line);
        store(field(node, &KdNode::axis), 0);
        sint state = select(empty, sint(node_leaf), sint(node_unsplit));
        store_release(field(node, &KdNode::state), state);
    }
    return children;
}

/// Writes the list of a leaf, every item a block.
inline void make_leaf(const Context& c, const List& l) {
    close_list(l);
    Leaf leaf = survey(c, l);
    pointer<ItemList> header = l.header;
    store(field(header, &ItemList::level), leaf.level);
    sfloat coarse = power_of_two(leaf.level);
    store(field(header, &ItemList::coarse), coarse);
    store(field(header, &ItemList::coarsest), coarsest_target(coarse, leaf.high - leaf.low));
    pointer<float> low = field(header, &ItemList::low);
    store(low, leaf.low.x);
    store(low + 1, leaf.low.y);
    store(low + 2, leaf.low.z);
    pointer<float> high = field(header, &ItemList::high);
    store(high, leaf.high.x);
    store(high + 1, leaf.high.y);
    store(high + 2, leaf.high.z);
}

/// Node `finer` is for those rays for which the leaf, of that level, is too coarse.
inline void make_finer(const Context& c, const List& l, sint level, sint finer) {
    store(field(l.header, &ItemList::finer), finer);
    store_release(field(l.header, &ItemList::beyond), -1);
    pointer<KdNode> node = c.nodes + finer;
    note_list_level(l, level, 0);
    note_level(node, 1, level, 1);
    store(field(node, &KdNode::link), l.line);
    store(field(node, &KdNode::axis), 1);
    store_release(field(node, &KdNode::state), node_unsplit);
}

/// The new list; the old one is given back unless its line is `keep`.
inline List replace_list(const Context& c, const List& old, const List& by, sint keep) {
    if (branch(old.line != keep))
        free_list(c, old.line, old.stride);
    return by;
}

/// Opens the closed items that are large against the list's cell, and what is in them, until none is.
inline List open_large_items(const Context& c, List l, sint keep) {
    vfloat limit = vfloat(largest(l.high - l.low) * large_item);
    for (;;) {
        vmask few = vmask(l.count <= few_items);
        auto large = [&](const Items& v) {
            vvec extent{v.box[3] - v.box[0], v.box[4] - v.box[1], v.box[5] - v.box[2]};
            vmask wanted = few & is_patch(v);
            wanted = wanted | (largest(extent) > limit);
            return wanted & is_closed(v);
        };
        sint to_open = 0;
        for (sint i = 0; branch(i < l.count); i += isa::width) {
            vmask m = first_lanes(l.count - i);
            Items v = load_items(l, i, m);
            to_open += count(m & large(v));
        }
        if (branch(to_open == 0))
            return l;
        List opened = open_items(c, l, large);
        l = replace_list(c, l, opened, keep);
    }
}

inline sint count_closed(const List& l) {
    sint closed = 0;
    for (sint i = 0; branch(i < l.count); i += isa::width) {
        vmask m = first_lanes(l.count - i);
        vint item = load_vector(l.items + i, m);
        closed += count(m & (item >= vint(0)));
    }
    return closed;
}

/// Splits a node or makes it a leaf; returns its new state, not yet published.
[[gnu::noinline]] inline sint build_node(const Context& c, pointer<KdNode> node) {
    phase_scope phase(phase_build);
    sint line = load(field(node, &KdNode::link));
    List l = read_list(c, line);
    sint refine = load(field(node, &KdNode::axis));
    // The node's own list stays until nothing can fail any more; a coarser leaf's stays for good.
    sint own = l.line;
    sint own_stride = l.stride;
    auto give_back_own = [&](const List& used) {
        sbool done_with = used.line != own;
        done_with = done_with & (refine == 0);
        if (branch(done_with))
            free_list(c, own, own_stride);
    };
    if (branch(refine != 0))
        l = refine_items(c, l);
    for (;;) {
        l = open_large_items(c, l, own);
        sint closed = count_closed(l);
        sfloat item_cost = select(closed > 0, sfloat(closed_cost), sfloat(block_cost));
        Plane plane;
        plane.cost = 3.0e38F;
        if (branch(l.depth < kd_depth_limit))
            plane = choose_plane(l, item_cost);
        if (branch(plane.cost < to_float(l.count) * item_cost)) {
            sint children = split_list(c, l, plane);
            sint anchor = room_for_anchor(c, l.depth, refine);
            store(field(node, &KdNode::split), plane.at);
            store(field(node, &KdNode::axis), plane.axis);
            store(field(node, &KdNode::link), children);
            give_back_own(l);
            if (branch(anchor >= 0)) {
                if (branch(refine != 0)) {
                    begin_anchor(c, anchor, node, own, anchor_refines);
                } else {
                    close_list(l);
                    begin_anchor(c, anchor, node, l.line, 0);
                    return node_inner;
                }
            }
            free_list(c, l.line, l.stride);
            return node_inner;
        }
        if (branch(closed > 0)) {
            List opened = open_items(c, l, [](const Items& v) { return is_closed(v); });
            l = replace_list(c, l, opened, own);
            continue;
        }
        make_leaf(c, l);
        sint level = load(field(l.header, &ItemList::level));
        sfloat target = load(field(c.frame, &FrameHeader::fixed_target));
        sbool wanted = target == 0.0F; // by some ray
        wanted = wanted | (target >= power_of_two(level));
        if (branch(wanted | (level == least_level))) {
            sint anchor = -1;
            if (branch(refine != 0))
                anchor = room_for_anchor(c, l.depth, refine);
            sint finer = -1;
            if (branch(level != least_level))
                finer = allocate_nodes(c, 1);
            tighten(c, l);
            if (branch(level != least_level))
                make_finer(c, l, level, finer);
            store(field(node, &KdNode::link), l.line);
            give_back_own(l);
            if (branch(anchor >= 0))
                begin_anchor(c, anchor, node, own, anchor_refines | anchor_leaf);
            return node_leaf;
        }
        List finer = refine_items(c, l);
        l = replace_list(c, l, finer, own);
    }
}

/// Returns the state of a node that is no longer unsplit, splitting it if nobody else does. The caller builds
/// nothing meanwhile that others could wait for.
inline sint split_node(const Context& c, pointer<KdNode> node, sint seen) {
    pointer<shared_int> state = field(node, &KdNode::state);
    while (branch(seen < node_inner)) {
        if (branch(seen == node_unsplit)) {
            seen = compare_exchange(state, node_unsplit, node_busy);
            if (branch(seen == node_unsplit)) {
                BusyGuard guard(c, state, node_unsplit);
                seen = build_node(c, node);
                guard.publish(seen);
            }
        } else if (branch(seen < 0)) {
            seen = wake(c, state, seen);
        } else {
            seen = work_while(c, state, node_busy);
        }
    }
    return seen;
}

/// The root's list: the root of the scene graph, closed.
[[gnu::noinline]] inline void build_root(const Context& c) {
    phase_scope phase(phase_build);
    sint root = allocate_nodes(c, 1);
    svec low = load_svec(field(c.graph, &GraphNodeRecord::low));
    svec high = load_svec(field(c.graph, &GraphNodeRecord::high));
    List l = make_list(c, 1, 0, unbounded_target, low, high);
    store(l.items, graph_items);
    sfloat box[6] = {low.x, low.y, low.z, high.x, high.y, high.z};
    for (int k = 0; k < 6; ++k) {
        store(l.boxes + l.stride * k, box[k]);
        pointer<float> to =
            k < 3 ? field(c.tree, &TreeRecord::low) + k : field(c.tree, &TreeRecord::high) + (k - 3);
        store(to, box[k]);
    }
    close_list(l);
    pointer<KdNode> node = c.nodes + root;
    store(field(node, &KdNode::link), l.line);
    store(field(node, &KdNode::axis), 0);
    store_release(field(node, &KdNode::state), node_unsplit);
    store(field(c.tree, &TreeRecord::root), root);
}

/// Returns once the worker's tree has a root, making it if nobody else does.
inline void ensure_root(const Context& c) {
    build_once(c, field(c.tree, &TreeRecord::root_state), [&] { build_root(c); });
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
