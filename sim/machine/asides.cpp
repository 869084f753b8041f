#include "sim/machine/asides.h"

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}

} // namespace

void drop_copies(const Config& config, std::deque<Tile>& tiles, const Asker& who, std::uint64_t address,
                 cycle t, bool everywhere) {
    const unsigned levels = config.tile_levels();
    const auto in_tile = [&](Tile& tile) {
        for (Core& core : tile.cores)
            core.l1.invalidate(address, t, who.column);
        for (unsigned level = 1; level < levels; ++level)
            for (Cache& cache : tile.caches[level])
                if (&cache != &who.tile.cache_of(level, who.core))
                    cache.invalidate(address, t, who.column);
    };
    if (!everywhere)
        return in_tile(who.tile);
    for (Tile& tile : tiles)
        in_tile(tile);
    const bool shared = config.beyond_tiles(config.cache_levels() - 1);
    if (shared && config.cores_sharing(config.cache_levels() - 1) < config.all_cores())
        who.exit(levels).tell(Request::invalidate, address, t, who.column);
}

void claim_line(const Config& config, const Asker& who, std::uint64_t address, cycle t) {
    if (!config.coherence.kept())
        return;
    const unsigned levels = config.tile_levels();
    const Cache& last = who.tile.cache_of(levels - 1, who.core);
    if (last.holds(address) && !last.owns(address))
        who.exit(levels).tell(Request::claim, address, t, who.column);
}

void discard_below(const Config& config, const Asker& who, std::uint64_t address, std::uint64_t begin,
                   std::uint64_t end, cycle issued) {
    const unsigned levels = config.tile_levels();
    Tile& tile = who.tile;
    cycle at = issued;
    for (unsigned level = 1; level < config.cache_levels(); ++level) {
        const std::uint64_t bytes = wide(config.cache(level).line_bytes), first = address / bytes * bytes;
        if (first < begin || first + bytes > end)
            return;
        at += wide(config.cache(level - 1).latency);
        if (level < levels && tile.events)
            tile.arrivals[level][who.core / tile.sharing[level]]->discard(
                first, at,
                level == 1 ? tile.cores[who.core].l1.number() : tile.cache_of(level - 1, who.core).number());
        else if (level < levels)
            tile.cache_of(level, who.core).discard(first);
        else if (first == address)
            who.exit(levels).tell(Request::discard, first, issued, who.column);
    }
}

} // namespace sim
