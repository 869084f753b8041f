// What a run costs in energy: a pass over its counters afterwards. Each event has its energy and each part
// its power at rest (machine.energy, machine.memory); so no energy depends on data, temperature or voltage.
#pragma once

#include "sim/machine/report.h"

#include <vector>

namespace sim {

struct EnergyPart {
    const char* part;
    std::uint64_t events; // of a power: cycles until memory was quiet
    double joules;
    const char* meaning;
};
/// From the cores to memory, every part whether it costs anything or not.
std::vector<EnergyPart> energy_parts(const Report& report);

struct EnergyTotal {
    double joules = 0, seconds = 0; // until memory was quiet
    double watts() const { return seconds > 0 ? joules / seconds : 0; }
    /// Energy times delay: lower is better for those who weigh both alike.
    double joule_seconds() const { return joules * seconds; }
};
EnergyTotal total(const Report& report, const std::vector<EnergyPart>& parts);

} // namespace sim
