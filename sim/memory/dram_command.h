// What a channel tells the devices: for tests and traces.
#pragma once

#include "sim/memory/dram_timing.h"

namespace sim {

struct DramCommand {
    enum class Kind { activate, precharge, precharge_all, refresh, refresh_bank, read, write };
    Kind kind;
    Clock at;
    std::uint32_t channel, rank, group, bank;
    std::uint64_t row;
    bool automatic = false; // a precharge that came with a column command: not on the command bus
};

} // namespace sim
