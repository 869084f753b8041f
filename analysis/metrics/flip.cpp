#include "analysis/metrics/flip.h"

#include "analysis/metrics/colour.h"
#include "analysis/metrics/convolution.h"
#include "analysis/metrics/flip_filters.h"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

using Plane = std::vector<float>;
using Planes = std::array<Plane, 3>;

Colour at(const Planes& planes, std::size_t i) {
    return {planes[0][i], planes[1][i], planes[2][i]};
}

void set(Planes& planes, std::size_t i, const Colour& colour) {
    for (std::size_t c = 0; c < 3; ++c) {
        planes[c][i] = colour[c];
    }
}

Colour clamped(Colour colour) {
    for (float& value : colour) {
        value = std::clamp(value, 0.0F, 1.0F);
    }
    return colour;
}

Planes to_ycxcz(const LinearImage& image) {
    Planes out = image.planes;
    for (std::size_t i = 0; i < image.size(); ++i) {
        set(out, i, ycxcz_of_rgb(clamped(at(image.planes, i))));
    }
    return out;
}

Plane filtered(const Plane& plane, const LinearImage& size, const GaussianSum& filter) {
    Plane out(plane.size());
    for (const auto& [weight, row] : filter.terms) {
        const Plane term = convolve(plane, size.width, size.height, row, row);
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] += weight * term[i];
        }
    }
    return out;
}

/// What the eye resolves, as Hunt-adjusted CIELAB: filtered by contrast
/// sensitivity, clamped to what the display shows.
Planes seen(const Planes& ycxcz, const LinearImage& size, const SensitivityFilters& filters) {
    Planes out{filtered(ycxcz[0], size, filters.achromatic), filtered(ycxcz[1], size, filters.red_green),
               filtered(ycxcz[2], size, filters.blue_yellow)};
    for (std::size_t i = 0; i < out[0].size(); ++i) {
        set(out, i, hunt(lab_of_rgb(clamped(rgb_of_ycxcz(at(out, i))))));
    }
    return out;
}

/// HyAB to the power q_c = 0.7, compressed into [0, 1]: of the largest such difference that
/// a display can show, between green and blue, the first p_c = 0.4 take p_t = 0.95 of the range.
class ColourError {
public:
    float operator()(const Colour& a, const Colour& b) const {
        const float error = raised(a, b);
        const float e = error < knee_ ? 0.95F * error / knee_
                                      : 0.95F + (error - knee_) / (largest_ - knee_) * (1 - 0.95F);
        return std::min(e, 1.0F);
    }

private:
    static float raised(const Colour& a, const Colour& b) { return std::pow(hyab(a, b), 0.7F); }

    float largest_ = raised(hunt(lab_of_rgb({0, 1, 0})), hunt(lab_of_rgb({0, 0, 1})));
    float knee_ = 0.4F * largest_;
};

/// How much of an edge, and of a point, is at each pixel: lengths of the two detectors'
/// answers.
struct Features {
    Plane edge, point;
};

Plane length(const Plane& x, const Plane& y) {
    Plane out(x.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    }
    return out;
}

Features features(const Planes& ycxcz, const LinearImage& size, const FeatureFilters& filters) {
    Plane y = ycxcz[0];
    for (float& value : y) {
        value = (value + 16) / 116;
    }
    const auto detect = [&](const std::vector<float>& derivative) {
        return length(convolve(y, size.width, size.height, derivative, filters.gaussian),
                      convolve(y, size.width, size.height, filters.gaussian, derivative));
    };
    return {detect(filters.first), detect(filters.second)};
}

/// The larger of both differences, scaled to [0, 1], to the power q_f = 0.5.
float feature_error(const Features& a, const Features& b, std::size_t i) {
    const float difference =
        std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i])) / std::sqrt(2.0F);
    return std::sqrt(std::min(difference, 1.0F));
}

} // namespace

std::vector<float> ldr_flip(const LinearImage& a, const LinearImage& b, double pixels_per_degree) {
    const SensitivityFilters sensitivity = sensitivity_filters(pixels_per_degree);
    const FeatureFilters detectors = feature_filters(pixels_per_degree);
    const Planes opponent_a = to_ycxcz(a), opponent_b = to_ycxcz(b);
    const Planes seen_a = seen(opponent_a, a, sensitivity), seen_b = seen(opponent_b, b, sensitivity);
    const Features features_a = features(opponent_a, a, detectors);
    const Features features_b = features(opponent_b, b, detectors);
    const ColourError colour_error;
    std::vector<float> out(a.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        // Differences of features make those of colours more visible.
        out[i] = std::pow(colour_error(at(seen_a, i), at(seen_b, i)),
                          1 - feature_error(features_a, features_b, i));
    }
    return out;
}

} // namespace analysis
