#include "sim/machine/limits.h"

#include "sim/machine/derived.h"

#include <fmt/core.h>

#include <algorithm>

namespace sim {
namespace {

std::uint64_t busiest(const std::vector<CacheCounters>& caches) {
    std::uint64_t most = 0;
    for (const CacheCounters& c : caches)
        most = std::max(most, c.busy_cycles);
    return most;
}

/// Instructions of the core that issued most.
std::uint64_t most_instructions(const Report& r) {
    std::vector<std::uint64_t> cores(r.l1.size());
    for (const ThreadReport& t : r.threads)
        cores[static_cast<std::size_t>(t.core)] += t.instructions;
    return *std::max_element(cores.begin(), cores.end());
}

cycle core_cycles(const Config& c, std::uint64_t clocks) {
    return clocks * wide(c.memory.clock_ps) / wide(c.chip.clock_ps);
}

/// Clocks in which the busiest channel's bus moved data.
std::uint64_t bus_clocks(const Report& r) {
    std::uint64_t most = 0;
    std::size_t ranks = wide(r.config.memory.ranks);
    for (std::size_t channel = 0; channel < r.memory_by_rank.size(); channel += ranks) {
        std::uint64_t busy = 0;
        for (std::size_t rank = 0; rank < ranks; ++rank)
            busy += r.memory_by_rank[channel + rank].busy_clocks;
        most = std::max(most, busy);
    }
    return most;
}

/// Clocks that the activates of the busiest rank take at four in tFAW.
std::uint64_t activate_clocks(const Report& r) {
    std::uint64_t most = 0;
    for (const MemoryCounters& rank : r.memory_by_rank)
        most = std::max(most, rank.activates);
    return most < 4 ? 0 : (most - 4) / 4 * wide(r.config.memory.tFAW);
}

} // namespace

std::vector<Limit> limits(const Report& r) {
    const Config& c = r.config;
    std::vector<Limit> out = {
        {"issue slots", most_instructions(r) / wide(c.core.issue_width), "the core that issued most"},
        {"L1 ports", busiest(r.l1) / wide(c.l1.ports), "the core whose L1 was accessed most"},
        {"memory bus", core_cycles(c, bus_clocks(r)), "the channel that moved most"},
        {"row activates", core_cycles(c, activate_clocks(r)), "the rank that opened most rows, four in tFAW"},
    };
    constexpr std::array<const char*, most_levels> banks = {"", "L2 banks", "L3 banks", "L4 banks",
                                                            "L5 banks"};
    for (unsigned level = 1; level < c.cache_levels(); ++level)
        out.insert(out.begin() + 1 + level,
                   {banks[level], busiest(r.caches(level)) / wide(c.cache(level).banks),
                    "the cache of the level that was accessed most"});
    if (!r.network.ideal())
        out.insert(out.begin() + 1 + c.tile_levels(),
                   {"network", r.network.busiest().flits, "the link that moved most, a flit a cycle"});
    std::uint64_t port = 0;
    for (const auto& ports : r.port_instructions)
        for (std::uint64_t instructions : ports)
            port = std::max(port, instructions);
    std::uint64_t unit = 0;
    for (std::uint64_t cycles : r.shared_unit_cycles)
        unit = std::max(unit, cycles);
    if (c.core.shared_classes != "none")
        out.insert(out.begin() + 1, {"shared units", unit, "the unit of core.shared_classes that did most"});
    if (c.core.pairing != "any")
        out.insert(out.begin() + 1, {"issue ports", port, "the port of core.pairing that took most"});
    return out;
}

const Limit& binding(const std::vector<Limit>& all) {
    return *std::max_element(all.begin(), all.end(),
                             [](const Limit& a, const Limit& b) { return a.cycles < b.cycles; });
}

std::string limiter(const Report& r) {
    const std::vector<Limit> all = limits(r);
    const Limit& most = binding(all);
    double share = ratio(most.cycles, r.drained);
    if (share >= 0.6)
        return fmt::format("{}: busy for {:.0f} % of the run", most.resource, 100 * share);
    Stack s = r.stack();
    std::size_t longest = static_cast<std::size_t>(Cause::slots);
    for (std::size_t i = 0; i < s.size(); ++i)
        if (i != static_cast<std::size_t>(Cause::busy) && s[i] > s[longest])
            longest = i;
    return fmt::format(
        "waiting ({}, {:.0f} % of the threads' cycles: {}); the busiest resource, {}, works for {:.0f} % "
        "of the run",
        causes[longest].name, 100 * ratio(s[longest], r.cycles * r.threads.size()), causes[longest].meaning,
        most.resource, 100 * share);
}

} // namespace sim
