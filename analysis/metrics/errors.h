// Mean errors of a picture against a reference.
#pragma once

#include "analysis/images/linear_image.h"

#include <cstddef>
#include <vector>

namespace analysis {

/// Means over the counted pixels and R, G, B, of value v and reference r, as pbrt's imgtool defines them; a
/// render has no negative radiance, and where a reference has, the denominator's magnitude counts.
struct Errors {
    std::size_t pixels = 0;  // counted; where 0, the means are NaN
    double rmse = 0;         // root of the mean of (v - r)^2
    double relative_mse = 0; // (v - r)^2 / (r + 0.01)^2
    double mape = 0;         // |v - r| / |r + 0.01|, a fraction: 0.05 is 5 %
};

/// `counted` tells which pixels to take; both pictures have its size.
Errors errors(const LinearImage& picture, const LinearImage& reference, const std::vector<bool>& counted);

} // namespace analysis
