// Chances by which directions of a mapped sky are sampled.
#pragma once

#include "razor/scene/texture.h"

#include <vector>

namespace razor {

/// A map is sampled by its finest level with no more columns and rows than these.
inline constexpr int most_sky_columns = 1024, most_sky_rows = 512;
/// As often directions are sampled each as likely as any other, so that no light is missed that blends over
/// from brighter cells, and no chance is too small for single precision (Hesterberg, Weighted Average
/// Importance Sampling and Defensive Mixture Distributions, 1995).
inline constexpr double even_share = 0.01;

/// As SkyRecord wants them.
struct SkyDistribution {
    int columns = 0, rows = 0;
    std::vector<float> heights, row_sums, cell_sums, row_density;
};

/// Cells are as likely as what bilinear interpolation shows of the mean of red, green and blue in them, over
/// their solid angle. Nothing where the map is black.
SkyDistribution sky_distribution(const TexturePyramid& map);

} // namespace razor
