#include "sim/machine/asides.h"

#include "sim/trace/passing.h"

namespace sim {
namespace {

/// Word of a line.
void note_line(const Asker& who, unsigned level, traces::Kind kind, std::uint64_t address, cycle t) {
    note_word(who, level, kind, {address, 0, t, who.column}, Passing::to(level));
}

} // namespace

void note_word(const Asker& who, unsigned level, traces::Kind kind, const Access& a, std::uint32_t detail) {
    const TraceTap* tap = who.tile.tap;
    if (tap == nullptr || !tap->is_above(level)) [[likely]]
        return;
    const unsigned traced = tap->level() - 1; // the L1 is 0
    const std::size_t sharing = traced == 0 ? 1 : who.tile.sharing[traced];
    const auto stream =
        static_cast<std::uint32_t>((who.tile.number * who.tile.cores.size() + who.core) / sharing);
    who.tile.attribution.note_always(kind, a.address, a.bytes, a.at, a.column, stream, 0, traces::Part::aside,
                                     detail);
}

void drop_copies(const Config& config, std::deque<Tile>& tiles, const Asker& who, std::uint64_t address,
                 cycle t, bool everywhere) {
    const unsigned levels = config.tile_levels();
    const auto in_tile = [&](Tile& tile) {
        tile.site = {}; // of no operation, to prefetchers below
        for (Core& core : tile.cores)
            core.l1.invalidate(address, t, who.column);
        for (unsigned level = 1; level < levels; ++level)
            for (std::size_t n = 0; n < tile.caches[level].size(); ++n)
                if (Cache& cache = tile.caches[level][n]; &cache != &who.tile.cache_of(level, who.core)) {
                    cache.invalidate(address, t, who.column); // finds lines above, which is noted first
                    note_line({tile, n * tile.sharing[level], who.column}, level, traces::Kind::invalidate,
                              address, t);
                }
    };
    if (!everywhere)
        return in_tile(who.tile);
    for (Tile& tile : tiles)
        in_tile(tile);
    const bool shared = config.beyond_tiles(config.cache_levels() - 1);
    if (shared && config.cores_sharing(config.cache_levels() - 1) < config.all_cores()) {
        note_line(who, levels, traces::Kind::invalidate, address, t);
        who.exit(levels).tell(Request::invalidate, address, t, who.column);
    }
}

void claim_line(const Config& config, const Asker& who, std::uint64_t address, cycle t) {
    if (!config.coherence.kept())
        return;
    const unsigned levels = config.tile_levels();
    const Cache& last = who.tile.cache_of(levels - 1, who.core);
    if (last.holds(address) && !last.owns(address)) {
        note_line(who, levels, traces::Kind::claim, address, t);
        who.exit(levels).tell(Request::claim, address, t, who.column);
    }
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
        if (level < levels || first == address)
            note_line(who, level, traces::Kind::flush, first, level < levels ? at : issued);
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
