#include "sim/machine/derived.h"

namespace sim {

std::array<Bandwidth, 3> bandwidths(const Report& r) {
    auto real = [](auto x) { return static_cast<double>(x); };
    const Config& c = r.config;
    double ns = real(r.drained) * real(c.chip.clock_ps) * 1e-3;
    if (ns == 0)
        ns = 1;
    double core_clock = 1e3 / real(c.chip.clock_ps); // GHz
    // A bank is busy for whole cycles: the peak is what it moves then.
    double bank_cycles = real((c.l1.line_bytes + c.l2.bank_bytes - 1) / c.l2.bank_bytes);
    double ports = real(c.all_cores() * c.l1.ports * c.l1.port_bytes);
    double banks = real(c.chip.tiles * c.l2.banks * c.l1.line_bytes) / bank_cycles;
    double buses = real(c.memory.channels * c.memory.bus_bytes * c.memory.transfers_per_clock);
    return {{{"L1", real(r.l1_total().busy_cycles) * real(c.l1.port_bytes) / ns, ports * core_clock},
             {"L2", real(r.l2_total().reads + r.l2_total().writes) * real(c.l1.line_bytes) / ns,
              banks * core_clock},
             {"memory",
              real((r.memory.reads + r.memory.writes) * static_cast<std::uint64_t>(c.l2.line_bytes)) / ns,
              buses * 1e3 / real(c.memory.clock_ps)}}};
}

double cycles_per_instruction(const Report& r) {
    return ratio(r.cycles, r.core.instructions);
}

} // namespace sim
