// Room in a worker's arenas. Without a memory budget these are all there is; with one, a worker takes piece
// after piece of its tree's arena (razor/frame/budget.h).
#pragma once

#include "razor/frame/budget.h"
#include "razor/kernels/context.h"

namespace razor::ISA_TARGET {

inline pointer<WorkerBudget> budget_of(const Context& c) {
    return load(field(c.self, &WorkerRecord::budget));
}

struct Room {
    sint first, count;
};

/// The first run of free grains in [from, end), of up to about `most`.
inline Room next_run(pointer<std::int32_t> marks, sint era, sint from, sint end, sint most) {
    Room run{end, 0};
    for (; branch(from < end); from += isa::width) {
        vmask m = first_lanes(end - from);
        vint mark = load_vector(marks + from, m);
        m = m & (mark != vint(era));
        if (branch(any(m))) {
            run.first = from + first(m);
            break;
        }
    }
    sint stop = run.first;
    sint enough = min(run.first + most, end);
    while (branch(stop < enough)) {
        vmask m = first_lanes(enough - stop);
        vint mark = load_vector(marks + stop, m);
        m = m & (mark == vint(era));
        if (branch(any(m))) {
            stop = stop + first(m);
            break;
        }
        stop += isa::width;
    }
    run.count = min(stop, enough) - run.first;
    return run;
}

/// Lines for a later, smaller request.
inline void keep_hole(const Context& c, pointer<WorkerBudget> own, sint line, sint lines) {
    if (branch(lines < grain_lines))
        return;
    pointer<std::int32_t> hole = as<std::int32_t>(c.grids + line);
    sint next = load(field(own, &WorkerBudget::holes));
    store(hole, lines);
    store(hole + 1, next);
    store(field(own, &WorkerBudget::holes), line);
}

/// A hole of at least so many lines is looked for among this many.
inline constexpr int holes_tried = 8;
/// In lines; none: of 0.
inline Room find_hole(const Context& c, pointer<WorkerBudget> own, sint lines) {
    Room run{0, 0};
    sint before = -1;
    sint line = load(field(own, &WorkerBudget::holes));
    for (sint tried = 0; branch(tried < holes_tried); ++tried) {
        if (branch(line < 0))
            break;
        pointer<std::int32_t> hole = as<std::int32_t>(c.grids + line);
        sint count = load(hole);
        sint next = load(hole + 1);
        if (branch(count >= lines)) {
            if (branch(before < 0))
                store(field(own, &WorkerBudget::holes), next);
            else
                store(as<std::int32_t>(c.grids + before) + 1, next);
            run = {line, count};
            break;
        }
        before = line;
        line = next;
    }
    return run;
}

/// At least `need` grains of the tree's arena that lie side by side. Traps if there are none.
inline Room take_grains(const Context& c, pointer<WorkerBudget> own, sint need) {
    pointer<TreeBudget> tree = load(field(own, &WorkerBudget::tree));
    pointer<std::int32_t> marks = load(field(tree, &TreeBudget::marks));
    sint era = load(field(tree, &TreeBudget::era));
    sint end = load(field(tree, &TreeBudget::grains));
    sint piece = load(field(tree, &TreeBudget::piece));
    sint most = max(need, piece);
    sint at = load_acquire(field(tree, &TreeBudget::cursor));
    Room run;
    for (;;) {
        run = next_run(marks, era, at, end, most);
        while (branch(run.count < need)) {
            if (branch(run.count == 0))
                trap(trap_memory_spent);
            run = next_run(marks, era, run.first + run.count, end, most);
        }
        sint seen = compare_exchange(field(tree, &TreeBudget::cursor), at, run.first + run.count);
        if (branch(seen == at))
            break;
        at = seen;
    }
    // Runs that were too short.
    sint first_line = load(field(tree, &TreeBudget::first_line));
    while (branch(at < run.first)) {
        Room skipped = next_run(marks, era, at, run.first, most);
        sint line = skipped.first << grain_log2;
        sint lines = skipped.count << grain_log2;
        keep_hole(c, own, first_line + line, lines);
        at = skipped.first + skipped.count;
    }
    sint taken = load(field(own, &WorkerBudget::tile_grains));
    store(field(own, &WorkerBudget::tile_grains), taken + run.count);
    return run;
}

/// Where an arena's next `amount` units begin, of which a line has 2^UnitLog2, after a new piece was taken.
template <int UnitLog2>
[[gnu::noinline]] inline sint more_room(const Context& c, std::int32_t WorkerRecord::*next,
                                        std::int32_t WorkerRecord::*end, sint amount, TrapCode full) {
    pointer<WorkerBudget> own = budget_of(c);
    if (branch(is_null(own)))
        trap(full);
    constexpr int round_up = (1 << UnitLog2) - 1;
    sint left = load(field(c.self, next)) + round_up;
    left = left >> UnitLog2;
    sint left_end = load(field(c.self, end)) >> UnitLog2;
    store(field(c.self, next), 0);
    store(field(c.self, end), 0);
    keep_hole(c, own, left, left_end - left);
    sint lines = (amount + round_up) >> UnitLog2;
    Room room = find_hole(c, own, lines);
    if (branch(room.count == 0)) {
        Room grains = take_grains(c, own, (lines + (grain_lines - 1)) >> grain_log2);
        pointer<TreeBudget> tree = load(field(own, &WorkerBudget::tree));
        room.first = grains.first << grain_log2;
        room.first = room.first + load(field(tree, &TreeBudget::first_line));
        room.count = grains.count << grain_log2;
    }
    store(field(c.self, end), (room.first + room.count) << UnitLog2);
    return room.first << UnitLog2;
}

/// Takes `amount` units from one of the worker's arenas.
inline sint allocate(const Context& c, std::int32_t WorkerRecord::*next, std::int32_t WorkerRecord::*end,
                     sint amount, TrapCode full) {
    sint begin = load(field(c.self, next));
    sint limit = load(field(c.self, end));
    if (branch(amount > limit - begin)) {
        if (full == trap_nodes_full)
            begin = more_room<records_a_line_log2>(c, next, end, amount, full);
        else
            begin = more_room<0>(c, next, end, amount, full);
    }
    store(field(c.self, next), begin + amount);
    return begin;
}

/// A record among the nodes.
inline sint allocate_nodes(const Context& c, sint amount) {
    return allocate(c, &WorkerRecord::node_next, &WorkerRecord::node_end, amount, trap_nodes_full);
}

/// Writes down that these blocks are made, and dropped, together.
[[gnu::noinline]] inline void begin_group(const Context& c, pointer<WorkerBudget> own, sint group, sint line,
                                          sint lines, sint blocks) {
    pointer<BlockGroup> record = as<BlockGroup>(c.nodes + group);
    sint shape = lines << 3;
    store(field(record, &BlockGroup::line), line);
    store(field(record, &BlockGroup::shape), shape | blocks);
    store(field(record, &BlockGroup::use), 0);
    sint next = load(field(own, &WorkerBudget::groups));
    store(field(record, &BlockGroup::next), next);
    store(field(own, &WorkerBudget::groups), group);
    for (sint i = 0; branch(i < blocks); ++i) {
        store(field(as<BlockHeader>(c.grids + line), &BlockHeader::group), group);
        line = line + lines;
    }
}

/// Room for blocks of `lines` each.
inline sint allocate_blocks(const Context& c, sint lines, sint blocks) {
    pointer<WorkerBudget> own = budget_of(c);
    sbool bounded = !is_null(own);
    sint group = -1;
    if (branch(bounded))
        group = allocate_nodes(c, 1);
    sint line =
        allocate(c, &WorkerRecord::grid_next, &WorkerRecord::grid_end, lines * blocks, trap_grids_full);
    if (branch(bounded))
        begin_group(c, own, group, line, lines, blocks);
    return line;
}

} // namespace razor::ISA_TARGET
