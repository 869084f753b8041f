#include "sim/machine/tile.h"

namespace sim {

/// From the last level of the tile up to the L2.
void Tile::make_caches(const Config& config) {
    const unsigned levels = config.tile_levels();
    const bool to_memory = levels == config.cache_levels();
    const auto cores = static_cast<std::size_t>(config.chip.cores);
    for (unsigned level = levels - 1; level > 0; --level) {
        sharing[level] = static_cast<std::size_t>(config.cores_sharing(level));
        const bool last = level + 1 == levels;
        for (std::size_t core = 0; core < cores; core += sharing[level]) {
            if (last)
                exits.emplace_back(number, static_cast<std::uint32_t>(exits.size()), to_memory,
                                   config.coherence.kept(), leaving, tickets, attribution);
            Below& below = last ? static_cast<Below&>(exits.back()) : way_to(level + 1, core);
            Cache& cache =
                caches[level].emplace_back(config, level, last, earliest, site, below, tickets, attribution);
            if (events)
                arrivals[level].push_back(&events->before(cache));
            if (!last)
                cache_of(level + 1, core).add_above(cache);
            if (level == 1)
                jitters.emplace_back(config, number, static_cast<std::uint32_t>(jitters.size()),
                                     way_to(level, core));
        }
    }
}

Core& Tile::add_core(const Config& config, std::size_t pairing_ports) {
    const std::size_t number = cores.size(), group = number / sharing[1];
    Below& l2 = way_to(1, number);
    Below& below = config.sim.jitter != 0 ? static_cast<Below&>(jitters[group]) : l2;
    Core& core = cores.emplace_back(config, earliest, pairing_ports, site, l2, below, tickets, attribution);
    caches[1][group].add_above(core.l1);
    return core;
}

} // namespace sim
