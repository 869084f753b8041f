// A quantity of pixels, as the bytes that each one's rays touched, laid over the picture itself.
#pragma once

#include "analysis/images/linear_image.h"
#include "analysis/plots/png.h"

#include <string>
#include <vector>

namespace analysis {

struct OverlayScale {
    double low = 0, high = 1; // what is below and above looks like these
    bool logarithmic = false; // both are above 0
};
/// Of all values that are finite and, if it is logarithmic, above 0.
OverlayScale scale_of(const std::vector<double>& values, bool logarithmic);

/// The picture in grey, tinted from blue over green to red by `values` (one a pixel, rows from the top);
/// where there is none (no finite number, or nothing to take a logarithm of) it stays grey. Radiance is shown
/// up to 1.
Pixels overlaid(const LinearImage& picture, const std::vector<double>& values, const OverlayScale& scale);

/// With what colours say, as an SVG element.
std::string overlay_svg(const Pixels& pixels, const OverlayScale& scale, const std::string& name);

} // namespace analysis
