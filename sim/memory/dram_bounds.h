// What a memory can reach at most, in closed form.
#pragma once

#include "sim/config/config.h"

#include <string>

namespace sim {

struct DramBound {
    double bytes_per_clock = 0;
    std::string by; // what limits it
};

/// The part of the time in which a rank is not being refreshed.
double dram_awake(const MemoryConfig& c);
/// Of all data buses, in bytes a memory clock.
double dram_peak(const MemoryConfig& c);

/// The bandwidth that no schedule of a stream (dram_streams.h) exceeds when the memory is large and the
/// mapping spreads lines over all banks: of the data bus, of its turnarounds, of the activates that tFAW and
/// tRRD allow, of the row cycle of all banks or of one, whichever is least, less refresh. Of a strided stream
/// only the bus.
DramBound dram_bandwidth_bound(const Config& config, const std::string& stream);

/// The mean latency in clocks of a random read of an otherwise idle memory, reads coming `gap` clocks apart
/// at random times: tRCD + tCL + the line's bursts + tRP where the row of another is open + what a refresh
/// lets it wait. A row stays open from its access to the next refresh (page policy "open").
double dram_idle_latency(const Config& config, double gap);

} // namespace sim
