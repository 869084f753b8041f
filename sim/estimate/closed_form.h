// A whole chip in closed form: what one tile says (seed.h) and how much work there is, as a closed network of
// queues. Customers are the threads at work; stations are what a core has one of (issue slots, ports), units
// that cores share, banks of caches, the network's middle, channels of memory; all other time is delay. Paces
// that follow (mean_value.h) render the screen tiles, worker by worker (screen_schedule.h).
// Not modelled: tiles that disturb each other's caches, kinds of work that differ in what they ask of
// stations, bursts of misses, who waits for whom while a tree is built (as long as in the seed).
#pragma once

#include "sim/config/config.h"
#include "sim/estimate/screen_schedule.h"
#include "sim/estimate/seed.h"

#include <string>
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

struct StationUse {
    std::string name, meaning;
    double utilisation = 0; // of the time in which tiles are rendered; the mean of all of a kind
};

struct Prediction {
    double cycles = 0, instructions = 0, reads = 0, writes = 0; // lines of memory
    double once_cycles = 0;                                     // of `cycles`
    double threads = 0;                 // at work, on average, while tiles are rendered
    double waiting = 0;                 // ... waiting for what others build
    double built = 0;                   // of the instructions, those of builds
    std::vector<StationUse> stations{}; // the busiest first
    std::string limiter;
};

/// Of a worker: where it runs, and which kd-tree it uses.
struct Seat {
    int core = 0, tree = 0;
};

/// `seats`: of all workers, in the order of their stretches of the screen.
Prediction predict(const Seed& seed, const Config& seed_machine, const Config& machine,
                   const ScreenWork& work, const std::vector<Seat>& seats);

/// Lines written to memory: those pushed out of the last caches, which hold so many, by lines that are read;
/// the share of them that are dirty is the seed's.
double written_lines(const Config& seed_machine, double seed_reads, double seed_writes, const Config& machine,
                     double reads);

/// Cycles of a memory channel for a line, in core clocks: of its bus, or of row activates where those take
/// longer (four in tFAW), with what refreshes leave of the time.
double line_service_cycles(const Config& machine, double activates_a_line);

} // namespace sim
