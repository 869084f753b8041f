// Lines from and to memory in closed form. What one tile says (seed.h) is taken apart into lines that some
// phase touches for the first time, which whoever renders has to read, and those that were read again, as the
// last cache had no room for them or too many threads wanted it. The first go with the work of each last
// cache of the machine; the latter also with what that work touches beyond what the cache holds, and with how
// many threads share it. What workers do before all else, each for itself, goes with their number; what all
// of them then do together leaves its lines in the cache of whoever did it, and is read again where others
// need it.
#pragma once

#include "sim/config/config.h"
#include "sim/estimate/frame_work.h"
#include "sim/estimate/seed.h"

#include <vector>

namespace sim {

struct LineTraffic {
    double reads = 0, writes = 0;
};

/// `seats`: of all workers, in the order of their stretches of the screen.
LineTraffic predict_lines(const Seed& seed, const Config& seed_machine, const Config& machine,
                          const ScreenWork& work, const std::vector<Seat>& seats);

} // namespace sim
