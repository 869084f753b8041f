// The memory as the last cache sees it: lines become bursts, core cycles memory clocks, and each burst goes
// to its channel. Pseudo channels of HBM are channels here, with command buses of their own (those of a real
// pair share one). Requests come in nearly nondecreasing order of time.
#pragma once

#include "sim/config/config.h"
#include "sim/core/stalls.h"
#include "sim/memory/dram_channel.h"

#include <vector>

namespace sim {

class Memory {
public:
    /// `disorder`: memory clocks by which a request may be earlier than its predecessors.
    Memory(const Config& config, std::uint64_t disorder);
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    /// A line of the last cache; returns the core cycle at which its last byte is back there.
    cycle read(std::uint64_t address, cycle t);
    /// Returns the core cycle at which the write queues have taken the line.
    cycle write(std::uint64_t address, cycle t);
    /// Sends what is still queued; returns the core cycle from which on memory is quiet.
    cycle drain();
    /// Of this many clocks the refreshes are counted from now on.
    void count_refreshes(Clock clocks);
    /// Sends what is still queued and counts refreshes until then. No requests follow.
    void finish();

    /// Sums over all ranks, and each: rank r of channel c at c x ranks + r.
    MemoryCounters counters() const;
    std::vector<MemoryCounters> rank_counters() const;
    /// Every command is appended to `log` (not in time order; refreshes by finish()).
    void set_log(std::vector<DramCommand>* log);

    /// Clocks that `requests` lines, and all that the write queues hold, may take one after another: what
    /// lies between a request and what is booked for it, at most.
    static std::uint64_t longest_service(const Config& config, std::uint64_t requests);

    /// Core cycles from an open row with nobody in the way: no read is shorter. One that the write queue
    /// answers is held back as long, so that tiles may run by themselves for this time.
    static std::uint64_t shortest_read(const Config& config);

private:
    Clock arrival(cycle t) const { return ((t + there_) * core_ps_ + memory_ps_ - 1) / memory_ps_; }
    cycle leave(Clock t) const { return (t * memory_ps_ + core_ps_ - 1) / core_ps_; }

    std::uint64_t core_ps_, memory_ps_, there_, back_;
    unsigned burst_shift_;
    std::uint32_t parts_; // bursts of a line
    DramMapping mapping_;
    DramTiming timing_;
    std::vector<DramChannel> channels_;
    cycle shortest_;
    std::vector<MemoryCounters> lines_; // reads and writes, by rank of the first burst
    Clock latest_ = 0;
};

} // namespace sim
