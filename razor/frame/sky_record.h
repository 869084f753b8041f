// How a map of the sky is sampled: cells of equal longitude and latitude, a row of them by the chance that
// its rows have, a cell by the chance that it has in its row, and in a cell each direction as likely as any
// other.
#pragma once

#include "isa/memory_types.h"

#include <cstdint>

namespace razor {

struct SkyRecord {
    std::int32_t map;                   // what it shows: the number of its MapRecord
    float turn;                         // of its columns against the world's longitude, in whole turns
    std::int32_t columns, rows;         // cells; rows from straight up down
    std::int32_t column_step, row_step; // the largest power of two below each; 0: there is only one
    isa::ref<float> heights;            // cosine from straight up where each row begins, and -1
    isa::ref<float> row_sums;           // chance of all rows before, from 0 to 1: rows + 1
    isa::ref<float> cell_sums;          // likewise of cells in their row: columns + 1 for each row
    isa::ref<float> row_density;        // by solid angle, of a cell that has all its row's chance
};

} // namespace razor
