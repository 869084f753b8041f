// The end of a frame: caches give up what they have changed, from the L1s down.
#pragma once

#include "sim/machine/beyond.h"
#include "sim/machine/tile.h"

namespace sim {

/// At cycle `t` all caches write dirty lines back of which `keep(address)` says so, and drop others; traffic
/// counts under `column`. `serve()` serves what leaves the tiles.
template <class Keep, class Serve>
void write_back_all(std::deque<Tile>& tiles, Beyond& beyond, cycle t, std::size_t column, const Keep& keep,
                    const Serve& serve) {
    for (Tile& tile : tiles) {
        tile.site = {};
        for (Core& core : tile.cores)
            core.l1.finish(t, column, keep);
    }
    serve();
    for (unsigned level = 1; level < most_levels; ++level) {
        bool any = false;
        for (Tile& tile : tiles)
            for (Cache& cache : tile.caches[level]) {
                cache.finish(t, column, keep);
                any = true;
            }
        if (any)
            serve();
    }
    beyond.write_back(t, column, keep);
}

} // namespace sim
