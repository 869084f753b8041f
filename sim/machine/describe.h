// What a chip is and can do at most, from its configuration alone.
#pragma once

#include "sim/config/config.h"
#include "sim/network/figures.h"

#include <string>
#include <vector>

namespace sim {

/// Rates are of the whole chip, latencies those of an idle machine, over ways of mean length.
struct ChipFigures {
    double instructions_per_second = 0; // issue slots
    double flops_per_second = 0;        // 32-bit, a fused multiply-add counts twice
    double l1_bytes = 0, l2_bytes = 0;  // of all caches of the level
    double l1_bytes_per_second = 0, l2_bytes_per_second = 0, memory_bytes_per_second = 0;
    double l1_ns = 0, l2_ns = 0;
    double memory_open_ns = 0,
           memory_closed_ns = 0; // a read, from the access to its last data: row open, none open
    struct Level {
        double bytes = 0, bytes_per_second = 0, ns = 0;
        integer caches = 0;
    };
    std::vector<Level> below; // the L2 and what follows it
    NetworkFigures network;
    double miss_bytes_per_second =
        0; // what all MSHRs of the last level together can fetch from closed rows (Little's law)
};
ChipFigures chip_figures(const Config& config);

/// In the largest binary unit of which there is one: "32 KiB".
std::string size_text(double bytes);

/// As lines for people.
std::string chip_text(const Config& config);

} // namespace sim
