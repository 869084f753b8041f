// HDR-FLIP: FLIP of radiance (Andersson et al., Eurographics 2021).
#pragma once

#include "analysis/images/linear_image.h"
#include "analysis/metrics/tone_mapping.h"

#include <vector>

namespace analysis {

/// For every pixel the largest LDR-FLIP error over the exposures, 0 to 1. All values are finite; both
/// pictures have the same size.
std::vector<float> hdr_flip(const LinearImage& picture, const LinearImage& reference,
                            double pixels_per_degree, ToneMapper mapper, const Exposures& exposures);

} // namespace analysis
