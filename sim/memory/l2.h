// The cache that cores share: banks interleaved by line, a bank busy while it moves a line, write-back,
// write-allocate, neither inclusive nor exclusive of the L1s. A line being filled counts as present; whoever
// hits it waits for the fill. Not modelled: the network to the cores (its time is part of the latency), bank
// ports of fills.
#pragma once

#include "sim/config/config.h"
#include "sim/core/calendar.h"
#include "sim/memory/attribution.h"
#include "sim/memory/cache_array.h"
#include "sim/memory/counters.h"
#include "sim/memory/memory.h"
#include "sim/memory/pool.h"

#include <vector>

namespace sim {

/// When an access is served, what served it, and when it got the MSHR it needed (0: none).
struct Answer {
    cycle ready;
    Cause from;
    cycle granted = 0;
};

class L2 {
public:
    L2(const Config& config, std::uint64_t ring_cycles, Memory& memory, Attribution& attribution);

    /// A line of the level above, at any byte address in it.
    Answer read(std::uint64_t address, cycle t, std::size_t phase) {
        return access(address, t, phase, false, true);
    }
    /// A line written back from above, or a released word; `whole` lines need no fill. Returns when it is
    /// accepted.
    Answer write(std::uint64_t address, cycle t, std::size_t phase, bool whole) {
        return access(address, t, phase, true, !whole);
    }
    /// A read-modify-write of a shared word: a read that leaves the line dirty.
    Answer modify(std::uint64_t address, cycle t, std::size_t phase) {
        Answer a = access(address, t, phase, false, true);
        lines_[array_.find(address >> line_shift_)].dirty = true;
        return a;
    }
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t address);
    const CacheCounters& counters() const { return counters_; }

private:
    struct Line {
        cycle ready = 0;
        bool dirty = false;
    };
    Answer access(std::uint64_t address, cycle t, std::size_t phase, bool write, bool needs_data);
    cycle evict(std::size_t entry, cycle t, std::size_t phase);

    unsigned line_shift_;
    std::uint64_t latency_, bank_mask_;
    std::uint32_t occupancy_;
    bool whole_lines_;
    CacheArray array_;
    std::vector<Line> lines_;
    std::vector<Calendar> banks_;
    Pool mshrs_, write_backs_;
    CacheCounters counters_;
    Memory& memory_;
    Attribution& attribution_;
};

} // namespace sim
