// Micro-kernels of the core whose cycles are known in closed form, for tests and for `razor-sim validate`.
#pragma once

#include "sim/machine/report.h"

#include <functional>
#include <string>
#include <vector>

namespace sim {

struct CoreForm {
    std::string name;           // what it does, and with which setting
    cycle cycles, instructions; // that it takes, exactly
    std::function<Report()> run;
};

/// One core, one thread, one lane for each logical lane, nothing in the way.
Config plain_core();

/// Dependent chains by latency, independent operations by issue width, pieces of vectors by lanes, chains of
/// them, an issue window, units that are not pipelined.
std::vector<CoreForm> core_forms();

} // namespace sim
