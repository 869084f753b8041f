// Memory that is done with: where the frame wants it (FrameHeader::discards), caches are told that what lies
// there is dead, so that they need not write it back. It costs an instruction a line, and natively nothing.
#pragma once

#include "razor/frame/scratch.h"
#include "razor/kernels/budget_room.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// Nobody reads these lines again before they are written anew. Ask c.discards first.
inline void discard_lines(pointer<Line> first, sint count) {
    constexpr int at_once = 64;
    for (sint i = 0; branch(i < count); i += at_once) {
        sint lines = min(count - i, sint(at_once));
        sint bytes = lines * line_bytes;
        discard(first + i, bytes);
    }
}

/// The worker's arenas, as far as it used them.
inline void discard_own(const Context& c) {
    const auto arena = [&](std::int32_t WorkerRecord::*next, std::int32_t WorkerRecord::*full,
                           std::int32_t FrameHeader::*size, pointer<Line> base, int units_log2) {
        sint last = load(field(c.self, next));
        sint first = load(field(c.self, full));
        first = first - load(field(c.frame, size));
        sint begin = first >> units_log2;
        last = last + ((1 << units_log2) - 1);
        sint end = last >> units_log2;
        sint lines = end - begin;
        discard_lines(base + begin, lines);
    };
    arena(&WorkerRecord::grid_next, &WorkerRecord::grid_end, &FrameHeader::grid_lines, c.grids, 0);
    arena(&WorkerRecord::node_next, &WorkerRecord::node_end, &FrameHeader::node_count, as<Line>(c.nodes),
          records_a_line_log2);
    arena(&WorkerRecord::list_next, &WorkerRecord::list_end, &FrameHeader::list_lines, c.lists, 0);
}

/// A tree's arena: what lies in it now, and what was dropped from it.
inline void discard_bounded(const Context& c, pointer<TreeBudget> tree) {
    sint first = load(field(tree, &TreeBudget::first_line));
    sint lines = load(field(tree, &TreeBudget::grains)) << grain_log2;
    discard_lines(c.grids + first, lines);
    discard_lines(as<Line>(c.nodes) + first, lines);
    discard_lines(c.lists + first, lines);
}

/// The worker has no tile any more. When nobody uses its tree, all that it has built there is dead, and what
/// it had for itself. (A worker of a frame of which more is to be rendered keeps it.)
[[gnu::noinline]] inline void discard_all(const Context& c) {
    phase_scope phase(phase_build);
    sint end = load(field(c.frame, &FrameHeader::tiles_end));
    sint tiles = load(field(c.frame, &FrameHeader::tiles));
    if (branch(end < tiles))
        return;
    pointer<shared_int> left = field(c.tree, &TreeRecord::left);
    sint sharers = load(field(c.tree, &TreeRecord::sharers));
    sint place = fetch_add(left, 1) + 1;
    sint done = place;
    while (branch(done != sharers))
        done = wait_while(left, done);
    pointer<WorkerBudget> budget = budget_of(c);
    if (branch(is_null(budget))) {
        discard_own(c);
    } else if (branch(place == sharers)) {
        discard_bounded(c, load(field(budget, &WorkerBudget::tree)));
    }
    constexpr int floats = line_bytes / 4;
    discard_lines(as<Line>(c.blends), c.slot_floats * blend_slots >> line_floats_log2);
    discard_lines(as<Line>(c.packets), 2 * spare_packets / floats);
    discard_lines(as<Line>(c.stack), 2 * spare_stack / floats);
    if (branch(!is_null(c.cuts)))
        discard_lines(as<Line>(c.cuts), 2 * light_cut_floats / floats);
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
