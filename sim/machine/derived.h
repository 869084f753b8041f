// Figures computed from a report's counters, for both printers.
#pragma once

#include "sim/machine/report.h"

namespace sim {

/// A level's data rate over the whole run, in GB/s, beside the most it can do.
struct Bandwidth {
    const char* level;
    double achieved, peak;
    double utilisation() const { return peak > 0 ? achieved / peak : 0; }
};
/// L1 ports, banks of each level below, memory buses.
std::vector<Bandwidth> bandwidths(const Report& r);

inline double ratio(std::uint64_t a, std::uint64_t b) {
    return b == 0 ? 0 : static_cast<double>(a) / static_cast<double>(b);
}
double cycles_per_instruction(const Report& r); // of the chip: cycles over all instructions

} // namespace sim
