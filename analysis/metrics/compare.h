// A picture against a reference: all metrics at once.
#pragma once

#include "analysis/images/linear_image.h"
#include "analysis/metrics/differences.h"
#include "analysis/metrics/errors.h"
#include "analysis/metrics/finite.h"
#include "analysis/metrics/flip_filters.h"
#include "analysis/metrics/pooling.h"
#include "analysis/metrics/tone_mapping.h"

#include <optional>
#include <string>
#include <vector>

namespace analysis {

/// How FLIP looks at the pictures. Exposures that are not given follow from the reference.
struct FlipOptions {
    double pixels_per_degree = analysis::pixels_per_degree({});
    ToneMapper tone_mapper = ToneMapper::aces;
    std::optional<double> start_exposure, stop_exposure; // stops
    std::optional<int> exposures;
};

struct Comparison {
    int width = 0, height = 0;
    Differences differences;      // of all channels
    NotFinite picture, reference; // in R, G, B
    Errors errors;                // of R, G, B; errors.pixels were compared, the others hold no finite number
    bool high_dynamic_range = true; // radiance: HDR-FLIP; else values on a display: LDR-FLIP
    Exposures exposures;            // of HDR-FLIP
    PooledErrors flip;
    std::vector<float> flip_map; // NaN where not compared
};

/// A picture and its name in messages.
struct NamedImage {
    const ImageFile& image;
    std::string name;
};

/// Throws ImageError, with one line, where the sizes differ, R, G, B (or Y) are missing, one picture holds
/// radiance and the other display values, or the exposures run backwards.
Comparison compare(const NamedImage& picture, const NamedImage& reference, const FlipOptions& options);

} // namespace analysis
