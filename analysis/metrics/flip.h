// LDR-FLIP: how different two pictures look when one flips to the other (Andersson et al., "FLIP: A
// Difference Evaluator for Alternating Images", HPG 2020).
#pragma once

#include "analysis/images/linear_image.h"

#include <vector>

namespace analysis {

/// The error of every pixel, 0 (looks the same) to 1. Light on a display, in [0, 1]; what lies outside is
/// clamped. All values are finite and both pictures have the same size. Neither is the reference: the
/// error is symmetric.
std::vector<float> ldr_flip(const LinearImage& a, const LinearImage& b, double pixels_per_degree);

} // namespace analysis
