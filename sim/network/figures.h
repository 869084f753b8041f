// What a network can do at most, and how far ways over it are, from a machine's configuration alone.
#pragma once

#include "sim/config/config.h"

namespace sim {

/// Of an ideal network all zero.
struct NetworkFigures {
    double link_bytes_per_second = 0, bisection_bytes_per_second = 0; // one way
    /// Of a line read on an idle machine, there and back, mean over all that may ask and all that may answer:
    double hops = 0, cycles = 0; // from a tile, hops one way
    double memory_cycles = 0;    // from a cache beyond the tiles to memory; 0: there is none
};
NetworkFigures network_figures(const Config& config);

} // namespace sim
