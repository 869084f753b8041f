#include "sim/memory/dram_bounds.h"

#include "sim/memory/dram_timing.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

double d(Clock x) {
    return static_cast<double>(x);
}
double real(integer x) {
    return static_cast<double>(x);
}
double bursts_of_line(const Config& config) {
    return real(config.last_cache().line_bytes) / real(config.memory.bus_bytes * config.memory.burst_length);
}

} // namespace

double dram_awake(const MemoryConfig& c) {
    return c.tREFI == 0 ? 1 : 1 - real(c.tRFC) / real(c.tREFI);
}

double dram_peak(const MemoryConfig& c) {
    return real(c.channels * c.bus_bytes * c.transfers_per_clock);
}

DramBound dram_bandwidth_bound(const Config& config, const std::string& stream) {
    const MemoryConfig& c = config.memory;
    const DramTiming t(c);
    const double line = real(config.last_cache().line_bytes), bursts = bursts_of_line(config);
    const double awake = c.refresh == "all-bank" ? dram_awake(c) : 1;
    const double in_turn = d(std::max(t.burst, t.column[0][0][at(Near::rank)])); // burst to burst
    DramBound bound{line / (bursts * in_turn) * real(c.channels), "bus"};
    auto limit = [&](double bytes_per_clock, const char* by) {
        if (bytes_per_clock < bound.bytes_per_clock)
            bound = {bytes_per_clock, by};
    };
    if (stream == "two-to-one" || stream == "triad") {
        // Batches as long as the write queue's watermarks say, and twice as many reads between them.
        double writes = real(c.write_high - c.write_low);
        double turns = d(t.column[0][1][at(Near::rank)] + t.column[1][0][at(Near::rank)]) - 2 * in_turn;
        limit(line / bursts / (in_turn + std::max(turns, 0.0) / (3 * writes)) * real(c.channels),
              "bus and its turnarounds");
    }
    if (stream == "random" || stream == "two-to-one") {
        double ranks = real(c.channels * c.ranks);
        limit(4 * line / d(t.tFAW) * ranks, "four activates (tFAW)");
        limit(line / d(t.activate[at(Near::rank)]) * ranks, "activate to activate (tRRD)");
        limit(line / d(t.tRC) * real(c.bank_groups * c.banks) * ranks, "row cycle of all banks");
    }
    if (stream == "hot-bank") {
        Clock open =
            t.tRCD + static_cast<Clock>(bursts - 1) * t.column[0][0][at(Near::group)] + t.precharge[0];
        limit(line / d(std::max(t.tRC, open + t.tRP)), "row cycle of one bank");
    }
    bound.bytes_per_clock *= awake;
    return bound;
}

double dram_idle_latency(const Config& config, double gap) {
    const MemoryConfig& m = config.memory;
    const DramTiming t(m);
    double line = d(t.tRCD + t.data[0]) + (bursts_of_line(config) - 1) * d(t.column[0][0][at(Near::group)]) +
                  d(t.burst);
    double banks = real(m.channels * m.ranks * m.bank_groups * m.banks);
    if (m.tREFI == 0)
        return line + d(t.tRP);
    double awake = d(t.tREFI - t.tRFC), visits = awake / gap / banks;
    double open = (1 - (1 - std::exp(-visits)) / visits) * dram_awake(m);
    // Also waits what comes too late to be read before the refresh.
    double blocked = d(t.tRFC + std::max(t.tRC, t.tRCD + t.precharge[0] + t.tRP));
    return line + open * d(t.tRP) + blocked * blocked / 2 / d(t.tREFI);
}

} // namespace sim
