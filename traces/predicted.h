// A block's references, and their order, each bit predicted by what came before (reference_model.h): five
// eighths of the room of columns, at a hundredth of their speed. For what L2s pass on, of which there is
// little, and in which hardly anything repeats itself.
#pragma once

#include "traces/reference_model.h"

#include <string>

namespace traces {

/// All of a block but its table, which is in the order of `rank`: `table[rank[c]]` is the block's class c.
void put_predicted(ReferenceModel& model, const Block& block, const std::vector<std::uint32_t>& rank,
                   const std::vector<Class>& table, unsigned shift, unsigned set_bits, std::string& out);

/// Fills a block whose segments and table are there. `ordered`: its order is known; `tiled`: so are tiles, of
/// numbers up to `most_tile`; `checked`: since version 7. Returns what is wrong with the bytes; null:
/// nothing.
const char* get_predicted(ReferenceModel& model, const std::string& bytes, unsigned shift, unsigned set_bits,
                          std::uint64_t first_time, bool ordered, bool tiled, bool checked,
                          std::uint32_t most_tile, Block& block);

} // namespace traces
