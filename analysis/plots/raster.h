// Drawings as pixels, for where SVG is not shown.
#pragma once

#include "analysis/plots/png.h"
#include "analysis/plots/svg.h"

namespace analysis {

/// The drawing at so many pixels a unit, on white, edges smoothed by 4 x 4 samples a pixel. Texts are of
/// stb_easy_font's letters, other characters than ASCII's as question marks. Throws std::invalid_argument for
/// a drawing that holds pictures: these are pixels already.
Pixels rasterised(const Svg& drawing, double scale);

} // namespace analysis
