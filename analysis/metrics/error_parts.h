// The error of a way to render, apart: what more samples would not take away, and noise.
#pragma once

#include "analysis/images/linear_image.h"

#include <span>
#include <vector>

namespace analysis {

/// A number and half of its 95 % interval (Student's t); NaN where the pictures are too few to tell.
struct Estimate {
    double value = 0, half_width = 0;
};

/// Means over the counted pixels and R, G, B, of pictures X that differ in their seeds alone beside the
/// truth r: E (X - r)^2 = (E X - r)^2 + E (X - E X)^2.
struct ErrorParts {
    Estimate bias_squared; // may come out below 0 where noise hides the bias
    Estimate variance;
};

/// Unbiased, from independent pictures x_i of the way and y_j of the reference: products of different ones
/// have no noise in their mean, so that bias^2 is the mean of (x_i - y_k) (x_j - y_l), i != j, k != l, and
/// the variance that of x_i^2 - x_i x_j. One reference counts as exact, none as a picture of zeros: the x_i
/// are then differences. Intervals are from jackknives over the x_i and, where there are three, the y_j: of a
/// bias that is none they are somewhat too wide. All NaN for less than two pictures. All have the same size.
ErrorParts error_parts(std::span<const LinearImage> pictures, std::span<const LinearImage> references,
                       const std::vector<bool>& counted);

} // namespace analysis
