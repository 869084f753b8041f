// A perceptual colour map for errors.
#pragma once

#include "analysis/metrics/colour.h"

namespace analysis {

/// Linear sRGB of an error in [0, 1], from black over purple and orange to white: a path through CIELAB whose
/// lightness is 100 times the error, so equal steps of error look equally large and survive in grey.
Colour error_colour(float error);

/// Linear sRGB of pixels without an error value, a green that the map does not hold.
inline constexpr Colour no_error_colour{0, 1, 0};

} // namespace analysis
