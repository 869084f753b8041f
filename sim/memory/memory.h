// DRAM: channels of banks with one open row each. A bank serves requests in the order they come; a request
// for the row that is about to be closed still goes before the closing (row look-back, in place of a
// first-ready queue). The data bus of a channel is a calendar. Refresh blocks a channel for tRFC every tREFI
// and closes all rows. Not modelled: ranks, bank groups, activation limits across banks (tRRD, tFAW), bus
// turnarounds, command bus, write queue.
#pragma once

#include "sim/config/config.h"
#include "sim/core/calendar.h"
#include "sim/core/stalls.h"
#include "sim/memory/counters.h"

#include <vector>

namespace sim {

class Memory {
public:
    Memory(const Config& config, std::uint64_t ring_clocks);

    /// A line of the L2; returns the core cycle at which its last byte is back at the L2.
    cycle read(std::uint64_t address, cycle t);
    /// Returns the core cycle at which the line is written.
    cycle write(std::uint64_t address, cycle t);
    const MemoryCounters& counters() const { return counters_; }

private:
    using clock = std::uint64_t; // memory clocks
    struct Bank {
        std::uint64_t row = no_row, closed_row = no_row;
        clock column_ok = 0;    // a column command to the open row
        clock precharge_ok = 0; // closing it
        clock activate_ok = 0;  // opening the next
        clock closing = 0;      // when closed_row was or will be closed
        clock closed_column_ok = 0;
        clock epoch = 0; // refresh interval of the last use
    };
    struct Channel {
        Calendar bus;
        std::vector<Bank> banks;
    };
    struct Place {
        std::size_t channel, bank;
        std::uint64_t row;
    };
    static constexpr std::uint64_t no_row = ~std::uint64_t{0};

    Place locate(std::uint64_t address) const;
    clock after_refresh(clock t) const;
    clock burst(std::uint64_t address, clock arrival, bool write);
    clock open_row(Bank& bank, std::uint64_t row, clock arrival);
    cycle transfer(std::uint64_t address, cycle t, bool write);

    MemoryConfig c_;
    std::uint64_t core_ps_, memory_ps_, there_, back_;
    std::uint64_t burst_bytes_, line_bytes_;
    std::uint32_t burst_clocks_;
    struct Field {
        unsigned shift = 0;
        std::uint64_t mask = 0;
    };
    Field channel_, bank_, row_;
    std::vector<Channel> channels_;
    MemoryCounters counters_;
};

} // namespace sim
