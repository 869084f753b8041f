// What bounds a run from below: the cycles that its busiest resource of each kind alone would take, were
// everything else free (a roofline).
#pragma once

#include "sim/machine/report.h"

#include <vector>

namespace sim {

struct Limit {
    const char* resource;
    cycle cycles; // no run of this work takes fewer
    const char* meaning;
};
/// In order from the core to memory. All are at most the run's drained cycles, a law.
std::vector<Limit> limits(const Report& report);
/// The largest of them.
const Limit& binding(const std::vector<Limit>& all);
/// One line: what bounds the run, or what it waits for if no resource is busy for most of it.
std::string limiter(const Report& report);

} // namespace sim
