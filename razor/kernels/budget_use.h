// Which parts of a tree with a memory budget were used lately: anchors asleep and awake
// (razor/frame/budget.h).
#pragma once

#include "razor/kernels/budget_room.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// The anchor is used in this epoch.
inline void keep_awake(pointer<WorkerBudget> own, pointer<Anchor> anchor, sint number) {
    sint epoch = load(field(own, &WorkerBudget::epoch));
    sint next = load(field(own, &WorkerBudget::awake));
    store(field(anchor, &Anchor::use), epoch);
    store(field(anchor, &Anchor::next), next);
    store(field(own, &WorkerBudget::awake), number);
}

/// The state of a node that was asleep.
[[gnu::noinline]] inline sint wake(const Context& c, pointer<shared_int> state, sint asleep) {
    sint number = sint(-1) - asleep;
    pointer<Anchor> anchor = as<Anchor>(c.nodes + number);
    sint leaf = load(field(anchor, &Anchor::list)) & anchor_leaf;
    sint awake = leaf + node_inner;
    sint seen = compare_exchange(state, asleep, awake);
    if (branch(seen != asleep))
        return seen;
    keep_awake(budget_of(c), anchor, number);
    return awake;
}
static_assert(int{node_inner} + int{anchor_leaf} == int{node_leaf});

/// All that the worker has woken or made goes to sleep.
inline void put_to_sleep(const Context& c, pointer<WorkerBudget> own) {
    sint number = load(field(own, &WorkerBudget::awake));
    while (branch(number >= 0)) {
        pointer<Anchor> anchor = as<Anchor>(c.nodes + number);
        sint node = load(field(anchor, &Anchor::node));
        sint next = load(field(anchor, &Anchor::next)); // its next waker's, as soon as it sleeps
        sint asleep = sint(-1) - number;
        store_release(field(c.nodes + node, &KdNode::state), asleep);
        number = next;
    }
    store(field(own, &WorkerBudget::awake), -1);
}

/// Room for an anchor if a node that was made from a list of this depth is to be one; -1: it is not.
inline sint room_for_anchor(const Context& c, sint depth, sint refine) {
    sint number = -1;
    if (branch(!is_null(budget_of(c)))) {
        sint part = depth & ((1 << anchor_depth_log2) - 1);
        sbool wanted = part == 0;
        wanted = wanted & (depth > 0);
        wanted = wanted | (refine != 0);
        if (branch(wanted))
            number = allocate_nodes(c, 1);
    }
    return number;
}

/// Of a node that is about to be published: it can be made again from the list at `line`.
inline void begin_anchor(const Context& c, sint number, pointer<KdNode> node, sint line, int flags) {
    pointer<Anchor> anchor = as<Anchor>(c.nodes + number);
    store(field(anchor, &Anchor::node), distance(c.nodes, node));
    sint list = line << 2;
    store(field(anchor, &Anchor::list), list | flags);
    keep_awake(budget_of(c), anchor, number);
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
