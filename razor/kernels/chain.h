// Leaves of many levels in one cell. A leaf's finer node is often a leaf itself: in a cell of one patch seen
// from near, leaves of a dozen levels follow each other, and what takes rays beyond the first mostly takes
// them beyond all but the last. So the first of such a chain keeps the deepest list beyond which all rays of
// some group went, and others go there at once if that is right for them too: boxes and what lists are
// bounded for only shrink on the way, so that nothing between could have kept them.
//
// Without a memory budget only: with one, what is finer may be dropped under it.
#pragma once

#include "razor/kernels/fields.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

/// ItemList::beyond: a list's line, and above that how many levels finer it is; -1: none.
inline constexpr int beyond_line_bits = 27;
inline constexpr int beyond_most_levels = 15;

/// The chain that a group walks along.
struct Chain {
    sint next = -1; // the node that the last list led to: whoever is in another has left the chain
    sint head = -1; // line of its first list
    sint level = 0; // of that
};

/// Whether a group that goes beyond the leaf's list would have gone beyond all coarser ones before it, too,
/// from `head` on. All of these are too coarse for some ray if this is, in a box that theirs hold. What is
/// finer is bounded there for coarsest_target(): edges at least twice as long as here, and what growth adds
/// along the box; so it is if no ray asks for more than twice as long ones near this box.
inline sbool others_are_passed(const Group& g, pointer<ItemList> head, pointer<ItemList> list,
                               const svec& low, const svec& high, sfloat coarse) {
    if (branch(g.fields.sloped)) {
        svec widest_low = load_svec(field(head, &ItemList::low));
        svec widest_high = load_svec(field(head, &ItemList::high));
        sfloat bound = load(field(list, &ItemList::coarsest)); // the least
        return most_target_in(g.fields, widest_low, widest_high, g.slack) <= bound;
    }
    sfloat twice = coarse * 2.0F;
    return most_near(g.fields, low, high, g.slack) < twice;
}

/// Whether all rays of the group go beyond a leaf's list: it is too coarse for some, in the box of all that
/// is finer or can move, and what is finer is bounded for what any of them asks. What is asked of lists
/// between `head`, the chain's first, and this one is the same, so that it does not matter whether somebody
/// has kept the way.
[[gnu::noinline]] inline sbool all_go_beyond(const Group& g, pointer<ItemList> head, pointer<ItemList> list) {
    svec low = load_svec(field(list, &ItemList::low));
    svec high = load_svec(field(list, &ItemList::high));
    sfloat coarse = load(field(list, &ItemList::coarse));
    sbool too_coarse = least_target_in(g.fields, low, high, g.slack) < coarse;
    if (branch(!too_coarse))
        return false;
    sfloat bound = load(field(list, &ItemList::coarsest));
    if (branch(most_target_in(g.fields, low, high, g.slack) > bound))
        return false;
    return others_are_passed(g, head, list, low, high, coarse);
}

/// The node that a group goes to at once which goes beyond the list at `line` and asks for `least` or more in
/// its box; -1: there is none, or it is not for them.
[[gnu::always_inline]] inline sint node_beyond(const Context& c, const Group& g, pointer<ItemList> list,
                                               sfloat coarse, sfloat least) {
    sint beyond = load_acquire(field(list, &ItemList::beyond));
    if (branch(beyond < 0))
        return -1;
    sint levels = beyond >> beyond_line_bits;
    sfloat finest = as_float(as_int(coarse) - (levels << 23)); // coarse / 2^levels
    if (branch(least >= finest))
        return -1;
    pointer<ItemList> deep = as<ItemList>(c.lists + (beyond & ((1 << beyond_line_bits) - 1)));
    if (branch(!all_go_beyond(g, list, deep)))
        return -1;
    return load(field(deep, &ItemList::finer));
}

/// The group goes from node `from`, a leaf with the list at `line`, to node `to`. Returns how many levels
/// finer the list is than the chain's first.
inline sint walk(Chain& chain, pointer<ItemList> list, sint line, sint from, sint to) {
    sint level = load(field(list, &ItemList::level));
    sbool begins = chain.next != from;
    chain.head = select(begins, line, chain.head);
    chain.level = select(begins, level, chain.level);
    chain.next = to;
    return chain.level - level;
}

/// Others may go beyond the list at `line` from the chain's first, `levels` coarser.
inline void keep_beyond(const Context& c, const Chain& chain, sint line, sint levels) {
    sbool deeper = levels > 0;
    deeper = deeper & (levels <= beyond_most_levels);
    deeper = deeper & ((line >> beyond_line_bits) == 0);
    if (branch(!deeper))
        return;
    pointer<ItemList> head = as<ItemList>(c.lists + chain.head);
    sint known = load_acquire(field(head, &ItemList::beyond));
    if (branch((known >> beyond_line_bits) >= levels))
        return;
    pointer<WorkerBudget> budget = load(field(c.self, &WorkerRecord::budget));
    if (branch(is_null(budget)))
        store_release(field(head, &ItemList::beyond), line | (levels << beyond_line_bits));
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
