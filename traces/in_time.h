// The references of a block's streams, merged by time.
#pragma once

#include "traces/reference.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace traces {

/// Visits the references of a block, visit(segment, number), in order of time as far as the order within
/// streams allows: always the earliest of the streams' next ones (of equals, that of the first stream), where
/// none counts as earlier than those before it in its stream.
template <class Visit> void each_in_time(const Block& block, Visit visit) {
    struct Next {
        std::uint64_t time;
        std::size_t segment, at;
        bool operator>(const Next& n) const { return time != n.time ? time > n.time : segment > n.segment; }
    };
    std::priority_queue<Next, std::vector<Next>, std::greater<>> next;
    for (std::size_t s = 0; s < block.segments.size(); ++s)
        next.push({block.times[block.segments[s].begin], s, block.segments[s].begin});
    while (!next.empty()) {
        Next n = next.top();
        next.pop();
        const Segment& s = block.segments[n.segment];
        do { // as long as it is the first
            visit(s, n.at++);
            if (n.at == s.end)
                break;
            n.time = std::max(n.time, block.times[n.at]);
        } while (next.empty() || next.top() > n);
        if (n.at != s.end)
            next.push(n);
    }
}

} // namespace traces
