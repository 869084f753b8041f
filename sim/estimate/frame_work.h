// How much work a frame is on a machine, and where its workers are.
#pragma once

#include <vector>

namespace sim {

/// Instructions by phase, the frame's end left out.
using PhaseWork = std::vector<double>;

/// What a frame asks for on this machine, by what can be counted without time.
struct ScreenWork {
    PhaseWork once{};               // done once, by all workers together
    std::vector<PhaseWork> tiles{}; // by screen tile, along the curve: what its rays take ...
    std::vector<PhaseWork> built{}; // ... and what it builds of its workers' tree
};

/// Of a worker: where it runs, and which kd-tree it uses.
struct Seat {
    int core = 0, tree = 0;
};

} // namespace sim
