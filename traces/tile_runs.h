// The column of a block that says for which tile of the picture its references were: runs of them, as a
// thread works for one tile long.
#pragma once

#include "traces/reference.h"

#include <string>

namespace traces {

/// Appends it, if any reference is of a tile.
void put_tiles(const Block& block, std::string& out);
/// Fills Block::tiles of a block whose segments are there. `most`: the last tile's number. Returns what is
/// wrong with the bytes; null: nothing.
const char* get_tiles(const std::string& column, std::uint32_t most, Block& block);

} // namespace traces
