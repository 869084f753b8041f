// What a core says of lines besides loading and storing them: that copies elsewhere go, that a word in one is
// its own now, that one is dead. Used by runs and by replays of their traces.
#pragma once

#include "sim/machine/tile.h"

#include <deque>

namespace sim {

/// A core of a tile, by its number there, and what that counts under.
struct Asker {
    Tile& tile;
    std::size_t core, column;

    TileExit& exit(unsigned tile_levels) const { return tile.exits[core / tile.sharing[tile_levels - 1]]; }
};

/// Notes, for a trace of what lies above, word to a level (1: the L2) that is not the next one's own doing.
void note_word(const Asker& who, unsigned level, traces::Kind kind, const Access& a, std::uint32_t detail);
/// Copies of the line go, but for those in the caches below the L1 that the core uses: in its tile, or in all
/// `everywhere`; also in other caches beyond the tiles, if there are several.
void drop_copies(const Config& config, std::deque<Tile>& tiles, const Asker& who, std::uint64_t address,
                 cycle t, bool everywhere);
/// On a coherent machine others that have a word's line lose it by the directory's hand too. That takes no
/// time of the writer's: coherence.remote_cycles does.
void claim_line(const Config& config, const Asker& who, std::uint64_t address, cycle t);
/// The line of each level below the L1 around this address is dead if it lies in [begin, end).
void discard_below(const Config& config, const Asker& who, std::uint64_t address, std::uint64_t begin,
                   std::uint64_t end, cycle issued);

} // namespace sim
