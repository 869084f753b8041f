// What lies beyond the tiles: the L2s' outgoing MSHRs and write-back buffers, and memory. Requests are served
// between windows, in the order (cycle, tile, sequence).
#pragma once

#include "sim/memory/below.h"
#include "sim/memory/memory.h"
#include "sim/memory/pool.h"

#include <functional>
#include <vector>

namespace sim {

class Beyond {
public:
    /// Answers a request's ticket: (tile, ticket, cycle).
    using Reply = std::function<void(std::uint32_t, cycle, cycle)>;

    Beyond(const Config& config, Reply reply);

    /// Takes what a tile sends; empties the list.
    void accept(std::vector<Request>& leaving);
    /// Serves everything that arrives before cycle `end`. What arrives after this is later.
    void serve(cycle end);
    static constexpr cycle everything = ~cycle{0};
    /// Memory writes what it has queued; returns the cycle from which on it and all requests are at rest.
    cycle drain() { return std::max(served_, memory_.drain()); }
    /// What follows counts by itself from this memory clock on.
    void count_from(std::uint64_t clock) { memory_.count_refreshes(clock); }
    /// Nothing follows: memory writes what it has queued.
    void finish() { memory_.finish(); }
    /// When the earliest request waits to be served; ~0: none does.
    cycle next() const { return waiting_.empty() ? ~cycle{0} : waiting_.front().at; }
    const Memory& memory() const { return memory_; }

private:
    struct Port {
        OrderedPool mshrs, write_backs;
    };
    void push(const Request& r);
    Request pop();

    std::vector<Port> ports_;      // by tile
    std::vector<Request> waiting_; // a heap, earliest first
    cycle served_ = 0;
    Memory memory_;
    Reply reply_;
};

} // namespace sim
