// Dropping what a tree with a memory budget used longest ago (razor/frame/budget.h). Nobody renders
// meanwhile.
//
// First all that can be reached is asked when it was used: nodes and lists with the anchor they lie under,
// blocks with the lists that name them. Then anchors that were used too long ago become unsplit again, groups
// of blocks that none of the lists left needs become absent, and what is left is marked. Blocks as the camera
// sees them (BlockHeader::seen) are all dropped: few are needed once the tiles where they lie are rendered.
#pragma once

#include "razor/kernels/blend.h"
#include "razor/kernels/kd_build.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// Ages told apart, in epochs; all that is older has the last one. Of age 0 is what lies under no anchor.
inline constexpr int ages = 64;
inline constexpr int scratch_ages = scratch_blend; // idle between tiles
static_assert(blend_floats >= ages);

struct Drop {
    pointer<WorkerRecord> workers;
    pointer<TreeBudget> tree;
    pointer<std::int32_t> marks;
    sint first_line, era;
    sint newest; // what lies under no anchor: later than all epochs so far
    sint last;   // what was last used then or before is dropped
};

/// `visit` is told of nodes, so many from a number on, and of the lines of lists, each with when it was used,
/// and says of each anchor whether it stays.
template <class Visit> inline void visit_tree(const Context& c, sint newest, const Visit& visit) {
    pointer<std::int32_t> stack = as<std::int32_t>(c.stack);
    sint root = load(field(c.tree, &TreeRecord::root));
    visit.nodes(root, 1, newest);
    store(stack, root);
    store(stack + 1, newest);
    sint depth = 2;
    const auto push = [&](sint node, sint use) {
        pointer<std::int32_t> top = stack + depth;
        store(top, node);
        store(top + 1, use);
        depth = depth + 2;
    };
    while (branch(depth > 0)) {
        depth = depth - 2;
        pointer<std::int32_t> top = stack + depth;
        sint number = load(top);
        sint use = load(top + 1);
        pointer<KdNode> node = c.nodes + number;
        sint state = load_acquire(field(node, &KdNode::state));
        if (branch(state < 0)) {
            sint record = sint(-1) - state;
            pointer<Anchor> anchor = as<Anchor>(c.nodes + record);
            sint list = load(field(anchor, &Anchor::list));
            sint own = load(field(anchor, &Anchor::use));
            sint refines = list & anchor_refines;
            if (branch(refines == 0))
                visit.list(list >> 2, use);
            if (branch(visit.goes(own))) {
                store(field(node, &KdNode::link), list >> 2);
                store(field(node, &KdNode::axis), refines);
                store_release(field(node, &KdNode::state), node_unsplit);
                continue;
            }
            use = own;
            visit.nodes(record, 1, use);
            state = (list & anchor_leaf) + node_inner;
        }
        sint link = load(field(node, &KdNode::link));
        if (branch(state == node_inner)) {
            visit.nodes(link, 2, use);
            push(link, use);
            push(link + 1, use);
            continue;
        }
        if (branch(state == node_unsplit)) {
            sint refines = load(field(node, &KdNode::axis));
            if (branch(refines == 0))
                visit.list(link, use);
            continue;
        }
        if (branch(link < 0))
            continue;
        visit.list(link, use);
        sint finer = load(field(as<ItemList>(c.lists + link), &ItemList::finer));
        if (branch(finer >= 0)) {
            visit.nodes(finer, 1, use);
            push(finer, use);
        }
    }
}

/// Goes through the workers that share the tree.
template <class Visit> inline void visit_workers(const Drop& d, const Visit& visit) {
    sint workers = load(field(d.tree, &TreeBudget::frame_workers));
    sint tree = load(field(d.tree, &TreeBudget::tree));
    for (sint w = 0; branch(w < workers); ++w) {
        pointer<WorkerRecord> worker = d.workers + w;
        sint of = load(field(worker, &WorkerRecord::tree));
        if (branch(of == tree))
            visit(worker, load(field(worker, &WorkerRecord::budget)));
    }
}

/// Goes through the groups of blocks that the tree's workers made; keeps those of which `stays` is true.
template <class Stays> inline void visit_groups(const Context& c, const Drop& d, const Stays& stays) {
    visit_workers(d, [&](pointer<WorkerRecord>, pointer<WorkerBudget> own) {
        sint number = load(field(own, &WorkerBudget::groups));
        sint kept = -1;
        while (branch(number >= 0)) {
            pointer<BlockGroup> group = as<BlockGroup>(c.nodes + number);
            sint next = load(field(group, &BlockGroup::next));
            if (branch(stays(group, number))) {
                store(field(group, &BlockGroup::next), kept);
                kept = number;
            }
            number = next;
        }
        store(field(own, &WorkerBudget::groups), kept);
    });
}

/// When everything was used: lines by age, in quarters.
struct AskUse {
    const Context& c;
    const Drop& d;

    void count(sint use, sint quarters) const {
        sint age = d.newest - use;
        age = min(age, sint(ages - 1));
        pointer<std::int32_t> bin = as<std::int32_t>(c.stack + scratch_ages) + age;
        sint sum = load(bin);
        store(bin, sum + quarters);
    }
    sbool goes(sint) const { return false; }
    void nodes(sint, sint amount, sint use) const { count(use, amount); }
    void list(sint line, sint use) const {
        List l = read_list(c, line);
        count(use, list_lines(l.stride) << records_a_line_log2);
        for (sint i = 0; branch(i < l.count); i += isa::width) {
            vmask m = first_lanes(l.count - i);
            vint item = load_vector(l.items + i, m);
            m = m & (item < vint(0));
            for (; branch(any(m)); m = clear_first(m))
                needs(sint(-1) - extract(item, first(m)), use);
        }
    }
    /// Whoever needs a block needs all that it is a part of.
    void needs(sint line, sint use) const {
        while (branch(line >= 0)) {
            pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
            sint number = load(field(block, &BlockHeader::group));
            pointer<BlockGroup> group = as<BlockGroup>(c.nodes + number);
            sint before = load(field(group, &BlockGroup::use));
            if (branch(before >= use))
                break;
            store(field(group, &BlockGroup::use), use);
            line = load(field(block, &BlockHeader::parent));
        }
    }
};

/// Marks what stays.
struct KeepRest {
    const Context& c;
    const Drop& d;

    void mark_lines(sint line, sint lines) const {
        sint from = (line - d.first_line) >> grain_log2;
        sint last = line + lines;
        last = (last - (d.first_line + 1)) >> grain_log2;
        vint era = vint(d.era);
        for (; branch(from <= last); from += isa::width) {
            vmask m = first_lanes(last + 1 - from);
            store_vector(d.marks + from, era, m);
        }
    }
    sbool goes(sint use) const { return use <= d.last; }
    void nodes(sint number, sint amount, sint) const {
        sint line = number >> records_a_line_log2;
        sint end = (number + amount) - 1;
        end = (end >> records_a_line_log2) + 1;
        mark_lines(line, end - line);
    }
    void list(sint line, sint) const {
        sint stride = load(field(as<ItemList>(c.lists + line), &ItemList::stride));
        mark_lines(line, list_lines(stride));
    }
    sbool group(pointer<BlockGroup> group, sint number) const {
        sint use = load(field(group, &BlockGroup::use));
        sint line = load(field(group, &BlockGroup::line));
        sint shape = load(field(group, &BlockGroup::shape));
        sint step = lines_between(shape);
        sint blocks = children_in(shape);
        sbool stays = use > d.last;
        if (branch(stays)) {
            nodes(number, 1, use);
            mark_lines(line, step * blocks);
            for (sint i = 0; branch(i < blocks); ++i) {
                store_release(field(as<BlockHeader>(c.grids + line), &BlockHeader::seen), absent);
                line = line + step;
            }
            return stays;
        }
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint parent = load(field(block, &BlockHeader::parent));
        if (branch(parent >= 0)) {
            store_release(field(as<BlockHeader>(c.grids + parent), &BlockHeader::children), absent);
        } else {
            sint patch = load(field(block, &BlockHeader::patch));
            store_release(field(c.open + patch, &OpenPatch::state), absent);
        }
        return stays;
    }
};

/// A time such that what was used after it takes half of the arena, of so many grains, at most; or, if it was
/// used in the last epoch, all but an eighth.
inline sint choose_last(const Context& c, sint newest, sint grains) {
    sint half = grains << (grain_log2 + records_a_line_log2 - 1);
    sint most = half + half;
    most = most - (most >> 3);
    pointer<std::int32_t> bins = as<std::int32_t>(c.stack + scratch_ages);
    sint sum = 0;
    sint age = 0;
    for (; branch(age < ages); ++age) {
        sum = sum + load(bins + age);
        if (branch(sum > most))
            break;
        most = select(age == 0, most, half);
    }
    sbool enough = age == ages;
    return select(enough, sint(0), newest - age);
}

/// Nobody has anything left in hand, and unused lists are part of what is free.
inline void empty_hands(const Drop& d) {
    visit_workers(d, [&](pointer<WorkerRecord> worker, pointer<WorkerBudget> own) {
        constexpr std::int32_t WorkerRecord::*in_hand[] = {&WorkerRecord::grid_next, &WorkerRecord::grid_end,
                                                           &WorkerRecord::node_next, &WorkerRecord::node_end,
                                                           &WorkerRecord::list_next, &WorkerRecord::list_end};
        for (std::int32_t WorkerRecord::*word : in_hand)
            store(field(worker, word), 0);
        store(field(own, &WorkerBudget::holes), -1);
        pointer<float> stack = load(field(worker, &WorkerRecord::stack));
        pointer<std::int32_t> lists = as<std::int32_t>(stack + scratch_free_lists);
        for (int i = 0; i < list_sizes; i += isa::width)
            store_vector(lists + i, vint(-1), first_lanes(list_sizes - i));
    });
}

/// All anchors of the tree sleep; those that did not may have been used until now.
inline void put_all_to_sleep(const Context& c, const Drop& d) {
    visit_workers(d, [&](pointer<WorkerRecord>, pointer<WorkerBudget> own) {
        sint number = load(field(own, &WorkerBudget::awake));
        put_to_sleep(c, own);
        while (branch(number >= 0)) {
            pointer<Anchor> anchor = as<Anchor>(c.nodes + number);
            store(field(anchor, &Anchor::use), d.newest - 1);
            number = load(field(anchor, &Anchor::next));
        }
    });
}

/// The epoch that it is.
inline sint epoch_now(pointer<TreeBudget> tree) {
    sint cursor = load_acquire(field(tree, &TreeBudget::cursor));
    sint log2 = load(field(tree, &TreeBudget::epoch_log2));
    sint epoch = load(field(tree, &TreeBudget::epoch));
    return epoch + (cursor >> log2);
}

/// Drops what was used longest ago (see choose_last), or everything.
[[gnu::noinline]] inline void drop_oldest(const Context& c, pointer<TreeBudget> tree, sbool everything) {
    phase_scope phase(phase_build);
    Drop d;
    d.workers = load(field(c.frame, &FrameHeader::workers));
    d.tree = tree;
    d.marks = load(field(tree, &TreeBudget::marks));
    d.first_line = load(field(tree, &TreeBudget::first_line));
    d.era = load(field(tree, &TreeBudget::era)) + 1;
    d.newest = epoch_now(tree) + 1;
    d.last = d.newest;
    sint grains = load(field(tree, &TreeBudget::grains));
    put_all_to_sleep(c, d);
    sint root_state = load_acquire(field(c.tree, &TreeRecord::root_state));
    sbool some = root_state == ready;
    some = some & !everything;
    if (branch(some)) {
        pointer<std::int32_t> bins = as<std::int32_t>(c.stack + scratch_ages);
        for (int i = 0; i < ages; i += isa::width)
            store_vector(bins + i, vint(0), first_lanes(ages - i));
        AskUse ask{c, d};
        visit_tree(c, d.newest, ask);
        visit_groups(c, d, [&](pointer<BlockGroup> group, sint) {
            sint shape = load(field(group, &BlockGroup::shape));
            sint lines = lines_between(shape);
            lines = lines * children_in(shape);
            sint use = load(field(group, &BlockGroup::use));
            ask.count(use, (lines << records_a_line_log2) + 1);
            return sbool(true);
        });
        d.last = choose_last(c, d.newest, grains);
    }
    sint tree_number = load(field(tree, &TreeBudget::tree));
    note_dropping(*c.memory, tree_number, d.last);
    KeepRest rest{c, d};
    if (branch(d.last >= d.newest))
        store_release(field(c.tree, &TreeRecord::root_state), absent);
    else
        visit_tree(c, d.newest, rest);
    visit_groups(c, d, [&](pointer<BlockGroup> group, sint number) { return rest.group(group, number); });
    empty_hands(d);
    sint unused = 0;
    for (sint i = 0; branch(i < grains); i += isa::width) {
        vmask m = first_lanes(grains - i);
        vint mark = load_vector(d.marks + i, m);
        unused += count(m & (mark != vint(d.era)));
    }
    sfloat share = to_float(unused);
    share = share / to_float(grains);
    store(field(tree, &TreeBudget::free_share), share);
    store(field(tree, &TreeBudget::era), d.era);
    store(field(tree, &TreeBudget::epoch), d.newest);
    store_release(field(tree, &TreeBudget::cursor), 0);
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
