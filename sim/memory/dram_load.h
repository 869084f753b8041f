// A memory under a load: requests at random times, as many at once as are allowed, and what came of them.
#pragma once

#include "sim/memory/counters.h"
#include "sim/memory/dram_command.h"
#include "sim/memory/dram_streams.h"

#include <limits>
#include <string>
#include <vector>

namespace sim {

struct DramLoad {
    /// Clocks from one request to the next in the mean, at random (exponential); 0: at once.
    double gap = 0;
    /// Reads that have been sent and not answered, at most; the next request waits for an answer.
    std::uint64_t in_flight = 64;
    std::uint64_t requests = 100000;
    std::uint64_t seed = 1;
};

/// In memory clocks. A request's latency is from when it could be sent (its time had come and fewer than
/// in_flight reads were open) to its last data, the controller's own cycles left out.
struct DramOutcome {
    std::uint64_t requests = 0, reads = 0;
    double clocks = 0; // until the last data
    double bytes_per_clock = 0;
    double mean = 0, median = 0, p95 = 0, p99 = 0, longest = 0; // latency of reads
    MemoryCounters counters;
    std::vector<MemoryCounters> by_rank;
    std::vector<DramCommand> log; // where asked for
};

/// With the controller that answers when a request comes (Memory), or with the one with queues
/// (QueuedMemory).
DramOutcome run_dram_immediate(const Config& config, const DramStream& stream, const DramLoad& load,
                               bool with_log = false);
DramOutcome run_dram_queued(const Config& config, const DramStream& stream, const DramLoad& load,
                            bool with_log = false);

/// `config` with core cycles that are memory clocks, and no cycles of the controller's own.
Config in_memory_clocks(Config config);

} // namespace sim
