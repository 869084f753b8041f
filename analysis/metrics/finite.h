// Pixels that are not numbers: found, counted, and kept out of every mean.
#pragma once

#include "analysis/images/linear_image.h"

#include <cstddef>
#include <vector>

namespace analysis {

/// Pixels with a NaN, and pixels with an infinity but no NaN, in R, G or B.
struct NotFinite {
    std::size_t nan = 0, infinite = 0;
};
NotFinite count_not_finite(const LinearImage& image);

/// For each pixel, whether R, G and B are finite in both pictures, which have the same size.
std::vector<bool> finite_in_both(const LinearImage& a, const LinearImage& b);

/// Makes the pixels outside `mask` finite and equal in both pictures, so that filters near them see numbers
/// and no difference: the value of `b` where it is finite, else that of `a`, else 0, in each channel.
void equate_outside(const std::vector<bool>& mask, LinearImage& a, LinearImage& b);

} // namespace analysis
