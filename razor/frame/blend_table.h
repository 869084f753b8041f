// In which order the vertices of blocks are blended: the table that kernels read (layout.h).
#pragma once

#include <cstdint>

namespace razor {

/// Fills blend_table_words words.
void fill_blend_table(std::int32_t* table);

} // namespace razor
