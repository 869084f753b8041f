// A whole chip in closed form: what one tile says (seed.h) and how much work there is, as a closed network of
// queues. Customers are the threads at work; stations are what a core has one of (issue slots, ports), units
// that cores share, banks of caches, the network's middle, channels of memory; all other time is delay. Paces
// that follow (mean_value.h) render the screen tiles, worker by worker (screen_schedule.h). Lines of memory:
// line_traffic.h. (That the model misses the seed's own run by a tenth says little of other machines: to
// stretch what it computes for those by as much was tried, and did no good.)
// Not modelled: tiles that disturb each other's caches, kinds of work that differ in what they ask of
// stations, bursts of misses, who waits for whom while a tree is built (as long as in the seed).
#pragma once

#include "sim/config/config.h"
#include "sim/estimate/frame_work.h"
#include "sim/estimate/seed.h"

#include <string>
#include <vector>

namespace sim {

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

/// `seats`: of all workers, in the order of their stretches of the screen.
Prediction predict(const Seed& seed, const Config& seed_machine, const Config& machine,
                   const ScreenWork& work, const std::vector<Seat>& seats);

/// Cycles of a memory channel for a line, in core clocks: of its bus, or of row activates where those take
/// longer (four in tFAW), with what refreshes leave of the time.
double line_service_cycles(const Config& machine, double activates_a_line);

} // namespace sim
