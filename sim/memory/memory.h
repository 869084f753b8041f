// The memory whose controller answers at once (dram_channel.h), as the last cache sees it. Requests come in
// nearly nondecreasing order of time.
#pragma once

#include "sim/memory/dram_channel.h"
#include "sim/memory/memory_lines.h"

#include <vector>

namespace sim {

class Memory final : public MemoryLines {
public:
    /// `disorder`: memory clocks by which a request may be earlier than its predecessors.
    Memory(const Config& config, std::uint64_t disorder);

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
    MemoryCounters counters() const { return sum_of(rank_counters()); }
    std::vector<MemoryCounters> rank_counters() const { return rank_counters_of(channels_); }
    /// Every command is appended to `log` (not in time order; refreshes by finish()).
    void set_log(std::vector<DramCommand>* log);

    /// Clocks that `requests` lines, and all that the write queues hold, may take one after another: what
    /// lies between a request and what is booked for it, at most.
    static std::uint64_t longest_service(const Config& config, std::uint64_t requests);

private:
    std::vector<DramChannel> channels_;
    cycle shortest_;
    Clock latest_ = 0;
};

} // namespace sim
