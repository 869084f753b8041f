#include "sim/machine/energy.h"

#include <algorithm>

namespace sim {
namespace {

enum class Unit { logic, add, multiply, fused, divide };

Unit unit_of(std::size_t operation_class) {
    using isa::timing::operation;
    switch (static_cast<operation>(operation_class)) {
    case operation::add:
        return Unit::add;
    case operation::multiply:
    case operation::integer_multiply:
        return Unit::multiply;
    case operation::fused:
        return Unit::fused;
    case operation::divide:
    case operation::square_root:
        return Unit::divide;
    default:
        return Unit::logic;
    }
}

/// Lanes that computed, by unit. Loads and stores have none: their energy is that of the L1.
std::array<std::uint64_t, 5> lanes(const Report& r) {
    const auto wide = std::min<std::uint64_t>(static_cast<std::uint64_t>(r.config.core.lanes), ISA_WIDTH);
    std::array<std::uint64_t, 5> sum{};
    for (std::size_t c = 0; c < class_count; ++c)
        sum[static_cast<std::size_t>(unit_of(c))] += r.by_kind[c] + wide * r.by_kind[vector_kind(c)];
    return sum;
}

double seconds(const Report& r) {
    return static_cast<double>(r.drained) * static_cast<double>(r.config.chip.clock_ps) * 1e-12;
}

} // namespace

std::vector<EnergyPart> energy_parts(const Report& r) {
    const EnergyConfig& e = r.config.energy;
    const MemoryConfig& m = r.config.memory;
    std::vector<EnergyPart> out;
    const auto events = [&](const char* part, std::uint64_t count, double pj, const char* meaning) {
        out.push_back({part, count, static_cast<double>(count) * pj * 1e-12, meaning});
    };
    const auto power = [&](const char* part, integer parts, double mw, const char* meaning) {
        out.push_back({part, r.drained, static_cast<double>(parts) * mw * 1e-3 * seconds(r), meaning});
    };
    const CacheCounters l1 = r.l1_total(), l2 = r.l2_total();
    const auto computed = lanes(r);
    events("instructions", r.core.instructions, e.instruction_pj, "issued");
    constexpr std::array<const char*, 5> names = {"logic lanes", "add lanes", "multiply lanes", "fused lanes",
                                                  "divide lanes"};
    const std::array<double, 5> pj = {e.logic_pj, e.add_pj, e.multiply_pj, e.fused_pj, e.divide_pj};
    for (std::size_t u = 0; u < names.size(); ++u)
        events(names[u], computed[u], pj[u], "that computed, masked or not");
    events("L1 accesses", l1.busy_cycles, e.l1_access_pj, "of a port");
    events("L1 lines", l1.fills + l1.write_backs, e.l1_line_pj, "filled and written back");
    events("L2 lines", l2.reads + l2.writes + l2.fills + l2.write_backs, e.l2_line_pj,
           "accessed, filled and written back");
    constexpr std::array<const char*, most_levels> lower = {"", "", "L3 lines", "L4 lines", "L5 lines"};
    for (unsigned level = 2; level < r.config.cache_levels(); ++level) {
        const CacheCounters c = r.cache_total(level);
        events(lower[level], c.reads + c.writes + c.fills + c.write_backs, e.l2_line_pj,
               "accessed, filled and written back; charged as those of the L2");
    }
    if (!r.network.ideal())
        events("network", r.network.counters.byte_hops, e.network_pj, "bytes times hops");
    const CoherenceCounters& d = r.coherence;
    if (r.config.coherence.snoops())
        events("snoops", d.snoops, e.snoop_pj, "look-ups of tags for what others ask for");
    else if (r.config.coherence.kept())
        events("directory", d.reads + d.writes + d.upgrades + d.claims + d.recalled_lines, e.directory_pj,
               "look-ups, and lines recalled");
    events("memory rows", r.memory.activates, m.activate_pj, "opened and closed");
    events("memory reads", r.memory.read_bursts, m.read_pj, "bursts");
    events("memory writes", r.memory.write_bursts, m.write_pj, "bursts");
    const bool by_bank = m.controller == "queued" && m.refresh == "per-bank";
    const auto refreshed = static_cast<double>(by_bank ? m.bank_groups * m.banks : 1);
    events("memory refreshes", r.memory.refreshes, m.refresh_pj / refreshed,
           by_bank ? "of a bank" : "of a rank");
    power("memory at rest", m.channels * m.ranks, m.background_mw, "cycles until memory was quiet");
    power("cores at rest", r.config.all_cores(), e.core_mw, "cycles until memory was quiet");
    power("tiles at rest", r.config.chip.tiles, e.tile_mw, "cycles until memory was quiet");
    return out;
}

EnergyTotal total(const Report& r, const std::vector<EnergyPart>& parts) {
    EnergyTotal t;
    t.seconds = seconds(r);
    for (const EnergyPart& p : parts)
        t.joules += p.joules;
    return t;
}

} // namespace sim
