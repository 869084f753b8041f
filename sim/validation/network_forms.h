// What the network takes, in closed form, for tests and for `razor-sim validate`.
#pragma once

#include "sim/config/config.h"
#include "sim/core/stalls.h"

#include <functional>
#include <string>
#include <vector>

namespace sim {

/// A chip of so many tiles, links of 16 bytes, 3 cycles a hop, one memory channel at tile 0.
Config network_machine(const std::string& topology, integer tiles);

/// Hops between tiles by their places alone: ring and mesh of near-square shape.
integer hops_between(const Config& config, integer from, integer to);

/// A cold read of memory by each tile in turn, by itself on a machine: the way there, memory, the way back.
struct NetworkPing {
    std::string name;
    std::vector<cycle> expected, measured; // by tile
};
std::vector<NetworkPing> network_pings();

/// Messages of a line between tiles, all of them ready at the start: when the last one is there, beside what
/// the busiest links take.
struct NetworkLoad {
    std::string name, by; // what limits it
    cycle expected;
    std::function<cycle()> run;
};
std::vector<NetworkLoad> network_loads();

} // namespace sim
