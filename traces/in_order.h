// The references of a block in the order in which they were made.
#pragma once

#include "traces/in_time.h"

#include <vector>

namespace traces {

/// Calls visit(segment, number) for each reference of a block in the order that it says, and mark(turn) for
/// windows and the end; where it says none, in order of time (in_time.h). Throws Interrupted likewise.
template <class Visit, class Mark> void each_in_order(const Block& block, Visit visit, Mark mark) {
    if (block.order.empty())
        return each_in_time(block, visit);
    std::vector<std::size_t> next;
    for (const Segment& s : block.segments)
        next.push_back(s.begin);
    for (const Turn& turn : block.order) {
        check_interrupts();
        if (turn.what != Turn::What::references)
            mark(turn);
        else
            for (std::uint32_t i = 0; i < turn.count; ++i) {
                check_interrupts(i);
                visit(block.segments[turn.segment], next[turn.segment]++);
            }
    }
}

} // namespace traces
