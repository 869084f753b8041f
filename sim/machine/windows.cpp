#include "sim/machine/windows.h"

#include "sim/memory/memory_lines.h"
#include "sim/network/topology.h"
#include "sim/network/ways.h"

#include <algorithm>

namespace sim {

std::uint64_t to_core_cycles(const Config& c, integer memory_clocks) {
    return wide((memory_clocks * c.memory.clock_ps + c.chip.clock_ps - 1) / c.chip.clock_ps);
}

std::uint64_t to_memory_clocks(const Config& c, std::uint64_t core_cycles) {
    return (core_cycles * wide(c.chip.clock_ps) + wide(c.memory.clock_ps) - 1) / wide(c.memory.clock_ps);
}

std::uint64_t known_ahead(const Config& c) {
    const unsigned last = c.cache_levels() - 1;
    std::uint64_t ahead = MemoryLines::shortest_read(c);
    if (c.beyond_tiles(last))
        ahead = std::min(ahead, wide(c.cache(last).latency));
    if (c.coherence.kept() && !c.network.ideal())
        ahead = std::min(ahead, wide(c.coherence.snoops() ? c.coherence.snoop_cycles
                                                          : c.cache(c.tile_levels() - 1).latency));
    return ahead;
}

namespace {

std::uint64_t flits(const Config& c, integer bytes) {
    return static_cast<std::uint64_t>(flits_of(c.network, bytes));
}

std::uint64_t line_from_below(const Config& c) {
    const unsigned last = c.cache_levels() - 1;
    const Ways::Shortest way = Ways::shortest(c);
    // What has waited for queues is decided when it has long been there, and when a line is there is known
    // when it has come to its last link.
    if (c.memory.controller == "queued") {
        // A writer's line may wait for word that others have dropped it, which is as long known before.
        const bool word = c.coherence.kept() && !c.coherence.snoops() && !c.network.ideal();
        return known_ahead(c) + (word ? flits(c, c.network.request_bytes) : way.last_link);
    }
    if (!c.beyond_tiles(last))
        return way.there + MemoryLines::shortest_read(c) + way.back;
    // A cache's bank takes its turn when the request is there: only what follows can be counted on.
    return wide(c.cache(last).latency) + way.back;
}

/// Until a directory has looked up what a tile asks for; where a bank takes its turn, or requests act when
/// they are there, only what follows counts. Or until caches of its bus have heard of it.
std::uint64_t shortest_known(const Config& c) {
    const unsigned last = c.cache_levels() - 1;
    const bool beyond = c.beyond_tiles(last), when_there = beyond || c.memory.controller == "queued";
    const std::uint64_t there = when_there ? 0 : Ways::shortest(c).there;
    if (c.coherence.snoops())
        return there + wide(c.coherence.snoop_cycles);
    return there + wide(c.coherence.directory_cycles) + (beyond ? wide(c.cache(last).latency) : 0);
}

} // namespace

std::uint64_t shortest_answer(const Config& c) {
    // Who has the right to write a line by now gets it when the request is served.
    return c.coherence.kept() ? 0 : line_from_below(c);
}

std::uint64_t shortest_line(const Config& c) {
    if (!c.coherence.kept())
        return line_from_below(c);
    const Ways::Shortest way = Ways::shortest(c);
    const std::uint64_t told = shortest_known(c) + (c.coherence.snoops() ? 0 : way.there);
    return std::min(line_from_below(c), told + wide(c.cache(c.tile_levels() - 1).latency) + way.back);
}

// For the right to write alone hardly anybody waits, and windows as short as that would take many times as
// long.
std::uint64_t window_cycles(const Config& c) {
    if (c.sim.window != 0)
        return wide(c.sim.window);
    // An operation may follow the last piece of its operand by as many cycles less as it has pieces (rule 1).
    integer pieces = std::max<integer>(1, ISA_WIDTH / c.core.lanes);
    return wide(std::max<integer>(1, static_cast<integer>(shortest_line(c)) - (pieces - 1)));
}

std::uint64_t reach_cycles(const Config& c) {
    return booking_reach + window_cycles(c);
}

} // namespace sim
