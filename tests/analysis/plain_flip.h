// FLIP written once more, plainly: two-dimensional kernels in double precision, as the papers state them. An
// oracle for the separated, single-precision version; shares no code with it but the type of pictures.
#pragma once

#include "analysis/images/linear_image.h"

#include <vector>

namespace analysis::plain {

struct Kernel {
    int radius_x = 0, radius_y = 0;
    std::vector<double> weights; // rows from the top
};

/// Contrast sensitivity of channel 'A' (achromatic), 'R' (red-green) or 'B' (blue-yellow).
Kernel sensitivity_kernel(char channel, double pixels_per_degree);
/// The detector of edges (`order` 1) or points (2), across or down.
Kernel feature_kernel(int order, bool down, double pixels_per_degree);

std::vector<double> convolve(const std::vector<double>& plane, int width, int height, const Kernel& kernel);

std::vector<double> ldr_flip(const LinearImage& a, const LinearImage& b, double pixels_per_degree);

/// With ACES. The exposures are given.
std::vector<double> hdr_flip(const LinearImage& a, const LinearImage& b, double pixels_per_degree,
                             const std::vector<double>& exposures);

} // namespace analysis::plain
