// What every model of memory shares, whichever controller its channels have: lines and core cycles above,
// bursts and memory clocks below. Pseudo channels of HBM are channels here, with command buses of their own
// (those of a real pair share one).
#pragma once

#include "sim/config/config.h"
#include "sim/core/stalls.h"
#include "sim/memory/counters.h"
#include "sim/memory/dram_mapping.h"
#include "sim/memory/dram_timing.h"

#include <vector>

namespace sim {

class MemoryLines {
public:
    MemoryLines(const MemoryLines&) = delete;
    MemoryLines& operator=(const MemoryLines&) = delete;

    /// Core cycles from an open row with nobody in the way: no read is shorter. One that the write queue
    /// answers is held back as long, so that tiles may run by themselves for this time.
    static std::uint64_t shortest_read(const Config& config);

protected:
    explicit MemoryLines(const Config& config);
    ~MemoryLines() = default;

    /// The clock at which what leaves the last cache at core cycle `t` is at the controller, and the core
    /// cycle in which a clock begins.
    Clock arrival(cycle t) const { return ((t + there_) * core_ps_ + memory_ps_ - 1) / memory_ps_; }
    cycle leave(Clock t) const { return (t * memory_ps_ + core_ps_ - 1) / core_ps_; }
    /// The first core cycle `t` for which arrival(t) is later than the clock.
    cycle first_after(Clock clock) const {
        const std::uint64_t t = clock * memory_ps_ / core_ps_ + 1;
        return t > there_ ? t - there_ : 0;
    }
    /// A line's first burst, by number in memory.
    std::uint64_t first_burst(std::uint64_t address) const {
        return address >> burst_shift_ & ~std::uint64_t{parts_ - 1};
    }
    DramPlace place(std::uint64_t burst) const { return mapping_.locate(burst << burst_shift_); }
    /// Of the rank of a line's first burst.
    MemoryCounters& counters_of(const DramPlace& p) { return lines_[p.channel * ranks_ + p.rank]; }
    /// What was counted of lines, and by the channels.
    template <class Channels> std::vector<MemoryCounters> rank_counters_of(const Channels& channels) const {
        std::vector<MemoryCounters> out = lines_;
        auto to = out.begin();
        for (const auto& c : channels)
            for (const MemoryCounters& rank : c.counters())
                *to++ += rank;
        return out;
    }
    static MemoryCounters sum_of(const std::vector<MemoryCounters>& ranks) {
        MemoryCounters sum;
        for (const MemoryCounters& rank : ranks)
            sum += rank;
        return sum;
    }

    std::uint64_t core_ps_, memory_ps_, there_, back_; // there: core cycles of the way to the controller
    unsigned burst_shift_;
    std::uint32_t parts_; // bursts of a line
    std::size_t ranks_;
    DramMapping mapping_;
    DramTiming timing_;
    std::vector<MemoryCounters> lines_; // by channel and rank
};

} // namespace sim
