// Read-modify-writes of one line follow each other, in the order in which they reach the L2.
#pragma once

#include "sim/memory/tickets.h"

#include <array>
#include <utility>

namespace sim {

class WordQueues {
public:
    /// For an operation on the line of `address` that the L2 can serve at `ready` (a cycle or a ticket) and
    /// that keeps the line for `service` cycles, at least one: {r, n}, it acts n cycles after r. Of lines
    /// that meet in the table only the last is remembered.
    std::pair<cycle, cycle> enter(std::uint64_t address, cycle ready, cycle service, Tickets& tickets) {
        std::uint64_t line = address / 64;
        Queue& q = queues_[line % queues_.size()];
        service = service == 0 ? 1 : service;
        Answered known;
        if (is_ticket(q.ready) && q.ready != ready && tickets.find(q.ready, known))
            q.ready = known.last;
        bool follows = q.line == line && (q.ready == ready || (!is_ticket(ready) && !is_ticket(q.ready) &&
                                                               ready < q.ready + (q.behind + 1) * service));
        q = follows ? Queue{line, q.ready, q.behind + 1} : Queue{line, ready, 0};
        return {q.ready, q.behind * service};
    }

private:
    struct Queue {
        std::uint64_t line = ~std::uint64_t{0};
        cycle ready = 0;
        std::uint64_t behind = 0;
    };
    std::array<Queue, 256> queues_;
};

} // namespace sim
