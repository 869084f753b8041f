// What coherence of plain data takes, in closed form, for tests and for `razor-sim validate`.
#pragma once

#include "sim/machine/report.h"

#include <string>
#include <vector>

namespace sim {

/// network_machine() with a directory at its memory channel, at tile 0, of 5 cycles. `mode`: sim.mode.
Config coherent_machine(const std::string& topology, integer tiles, const std::string& mode = "fast");

/// One access to a line by a tile.
struct TimedAccess {
    int tile;
    int word; // of the data: 16 a line
    bool write;
    int core = 0; // of the tile
};
/// Cycles between two of these, which no access takes.
inline constexpr integer access_gap = 4000;
/// Each core's thread 0 acts when its turn comes, `access_gap` cycles after the last. `latencies`: of those
/// that read.
Report act_in_turn(const Config& config, const std::vector<TimedAccess>& accesses,
                   std::vector<cycle>* latencies = nullptr);

struct CoherenceForm {
    std::string name, by;
    std::vector<cycle> expected, measured;
};
/// Ping-pong of a line between two tiles, a producer with several consumers, false sharing, a write of what
/// others share. In both modes these take as long.
std::vector<CoherenceForm> coherence_forms(const std::string& mode);

} // namespace sim
