#include "analysis/metrics/tone_mapping.h"

#include "analysis/metrics/colour.h"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

/// (a x^2 + b x) / (c x^2 + d x + e): all three curves have this form.
struct Curve {
    double a, b, c, d, e;
};

/// `curve` of `factor` times x.
constexpr Curve prescaled(const Curve& curve, double factor) {
    return {curve.a * factor * factor, curve.b * factor, curve.c * factor * factor, curve.d * factor,
            curve.e};
}

constexpr double value(const Curve& k, double x) {
    return (k.a * x * x + k.b * x) / (k.c * x * x + k.d * x + k.e);
}

/// Hable's operator, ((x (A x + C B) + D E) / (x (A x + B) + D F)) - E / F, over its value at the white 11.2,
/// on twice the light.
constexpr Curve hable_curve() {
    constexpr double shoulder = 0.15, linear = 0.50, angle = 0.10, toe = 0.20, toe_top = 0.02,
                     toe_bottom = 0.30;
    constexpr double floor = toe_top / toe_bottom;
    Curve k{shoulder * (1 - floor), linear * (angle - floor), shoulder, linear, toe * toe_bottom};
    const double white = value(k, 11.2);
    k.a /= white;
    k.b /= white;
    return prescaled(k, 2);
}

constexpr Curve curve_of(ToneMapper mapper) {
    return mapper == ToneMapper::aces    ? prescaled({2.51, 0.03, 2.43, 0.59, 0.14}, 0.6)
           : mapper == ToneMapper::hable ? hable_curve()
                                         : Curve{0, 1, 0, 1, 1};
}

} // namespace

double tone_curve(ToneMapper mapper, double x) {
    return value(curve_of(mapper), x);
}

double inverse_tone_curve(ToneMapper mapper, double y) {
    // p x^2 + q x + r = 0
    const Curve k = curve_of(mapper);
    const double p = k.a - y * k.c, q = k.b - y * k.d, r = -y * k.e;
    const double root = std::sqrt(q * q - 4 * p * r);
    // The positive root, in the form that does not cancel and bears p = 0.
    return q > 0 ? -2 * r / (q + root) : (root - q) / (2 * p);
}

LinearImage tone_mapped(const LinearImage& image, ToneMapper mapper, double exposure) {
    const double scale = std::exp2(exposure);
    const Curve curve = curve_of(mapper);
    LinearImage out = image;
    for (std::size_t i = 0; i < image.size(); ++i) {
        std::array<double, 3> x{};
        for (std::size_t c = 0; c < 3; ++c) {
            x[c] = scale * std::max(0.0, double{image.planes[c][i]});
        }
        const double bright = luminance(x[0], x[1], x[2]);
        for (std::size_t c = 0; c < 3; ++c) {
            const double y = mapper == ToneMapper::reinhard ? x[c] / (1 + bright) : value(curve, x[c]);
            out.planes[c][i] = static_cast<float>(std::clamp(y, 0.0, 1.0));
        }
    }
    return out;
}

double Exposures::at(int i) const {
    return count == 1 ? start : start + (stop - start) * i / (count - 1);
}

int exposure_count(double start, double stop) {
    return std::max(2, static_cast<int>(std::ceil(stop - start)));
}

Exposures exposures_of(const LinearImage& reference, ToneMapper mapper) {
    std::vector<double> bright(reference.size());
    for (std::size_t i = 0; i < bright.size(); ++i) {
        bright[i] = luminance(std::max(0.0, double{reference.planes[0][i]}),
                              std::max(0.0, double{reference.planes[1][i]}),
                              std::max(0.0, double{reference.planes[2][i]}));
    }
    const auto median = [&] {
        const auto middle = bright.begin() + static_cast<std::ptrdiff_t>(bright.size() / 2);
        std::nth_element(bright.begin(), middle, bright.end());
        return *middle;
    };
    if (bright.empty() || *std::max_element(bright.begin(), bright.end()) == 0) {
        return {};
    }
    const double brightest = *std::max_element(bright.begin(), bright.end());
    double middle = median();
    if (middle == 0) {
        std::erase(bright, 0.0);
        middle = median();
    }
    const double x = inverse_tone_curve(mapper, 0.85);
    const double start = std::log2(x / brightest), stop = std::log2(x / middle);
    return {start, stop, exposure_count(start, stop)};
}

} // namespace analysis
