// Convolution with kernels that are products of a row and a column.
#pragma once

#include <span>
#include <vector>

namespace analysis {

/// out(x, y) = sum over i, j of row[r + i] column[s + j] plane(x + i, y + j), where row has 2 r + 1 and
/// column 2 s + 1 weights. Beyond the border the nearest pixel counts. `plane` is width * height values by
/// rows.
std::vector<float> convolve(const std::vector<float>& plane, int width, int height,
                            std::span<const float> row, std::span<const float> column);

} // namespace analysis
