#include "sim/machine/derived.h"

namespace sim {

std::vector<Bandwidth> bandwidths(const Report& r) {
    auto real = [](auto x) { return static_cast<double>(x); };
    const Config& c = r.config;
    double ns = real(r.drained) * real(c.chip.clock_ps) * 1e-3;
    if (ns == 0)
        ns = 1;
    double core_clock = 1e3 / real(c.chip.clock_ps); // GHz
    double ports = real(c.all_cores() * c.l1.ports * c.l1.port_bytes);
    std::vector<Bandwidth> out = {
        {"L1", real(r.l1_total().busy_cycles) * real(c.l1.port_bytes) / ns, ports * core_clock}};
    constexpr std::array<const char*, most_levels> names = {"L1", "L2", "L3", "L4", "L5"};
    for (unsigned level = 1; level < c.cache_levels(); ++level) {
        const CacheConfig& cache = c.cache(level);
        const CacheCounters all = r.cache_total(level);
        const integer line = c.cache(level - 1).line_bytes;
        // A bank is busy for whole cycles: the peak is what it moves then.
        double bank_cycles = real((line + cache.bank_bytes - 1) / cache.bank_bytes);
        double banks = real(r.caches(level).size()) * real(cache.banks * line) / bank_cycles;
        out.push_back({names[level], real(all.reads + all.writes) * real(line) / ns, banks * core_clock});
    }
    double buses = real(c.memory.channels * c.memory.bus_bytes * c.memory.transfers_per_clock);
    out.push_back(
        {"memory",
         real((r.memory.reads + r.memory.writes) * static_cast<std::uint64_t>(c.last_cache().line_bytes)) /
             ns,
         buses * 1e3 / real(c.memory.clock_ps)});
    return out;
}

double cycles_per_instruction(const Report& r) {
    return ratio(r.cycles, r.core.instructions);
}

} // namespace sim
