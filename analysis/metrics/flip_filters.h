// The kernels of FLIP, separated into rows and columns (Andersson, Nilsson, Akenine-Moeller, Oskarsson,
// Astroem, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020).
#pragma once

#include <vector>

namespace analysis {

/// How a picture is looked at. The defaults are the paper's.
struct ViewingConditions {
    double distance = 0.7;        // metres
    double monitor_width = 0.7;   // metres
    double monitor_pixels = 3840; // across
};

/// p = distance (pixels / width) pi / 180: pixels that one degree of the field of view covers.
double pixels_per_degree(const ViewingConditions& viewing);

/// A sum of products: kernel(x, y) = sum over terms of weight row(x) row(y); every row sums to 1, and so do
/// the weights.
struct GaussianSum {
    struct Term {
        float weight = 1;
        std::vector<float> row;
    };
    std::vector<Term> terms;
};

/// Contrast sensitivity as Gaussians in degrees, one filter a channel of YCxCz.
struct SensitivityFilters {
    GaussianSum achromatic, red_green, blue_yellow;
};
SensitivityFilters sensitivity_filters(double pixels_per_degree);

/// Detectors of edges and points: first and second derivative of a Gaussian across, the Gaussian along; the
/// positive weights of each detector sum to 1, the negative ones to -1.
struct FeatureFilters {
    std::vector<float> gaussian, first, second;
};
FeatureFilters feature_filters(double pixels_per_degree);

} // namespace analysis
