#include "analysis/metrics/flip_filters.h"

#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <numeric>

namespace analysis {
namespace {

using std::numbers::pi;

/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees: the filter of a sensitivity a exp(-b f^2) at f cycles a
/// degree.
struct Gaussian {
    double a, b;
};

/// `f` at -radius .. radius.
std::vector<double> samples(int radius, const std::function<double(double)>& f) {
    std::vector<double> out;
    for (int x = -radius; x <= radius; ++x) {
        out.push_back(f(x));
    }
    return out;
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

std::vector<float> scaled(const std::vector<double>& values, double factor) {
    std::vector<float> out;
    for (const double value : values) {
        out.push_back(static_cast<float>(factor * value));
    }
    return out;
}

/// The sum of Gaussians on a square of pixels, normalised as a whole.
GaussianSum normalised(std::initializer_list<Gaussian> gaussians, int radius, double pixels_per_degree) {
    GaussianSum out;
    double total = 0;
    for (const auto& [a, b] : gaussians) {
        const std::vector<double> row = samples(radius, [&, b = b](double x) {
            const double degrees = x / pixels_per_degree;
            return std::exp(-pi * pi * degrees * degrees / b);
        });
        const double volume = a * std::sqrt(pi / b) * sum(row) * sum(row);
        total += volume;
        out.terms.push_back({static_cast<float>(volume), scaled(row, 1 / sum(row))});
    }
    for (GaussianSum::Term& term : out.terms) {
        term.weight = static_cast<float>(double{term.weight} / total);
    }
    return out;
}

/// Scales positive values to sum to 1 and negative ones to -1.
std::vector<float> balanced(const std::vector<double>& values) {
    double positive = 0, negative = 0;
    for (const double value : values) {
        (value > 0 ? positive : negative) += value;
    }
    std::vector<float> out;
    for (const double value : values) {
        out.push_back(value == 0 ? 0.0F
                                 : static_cast<float>(value > 0 ? value / positive : -value / negative));
    }
    return out;
}

} // namespace

double pixels_per_degree(const ViewingConditions& viewing) {
    return viewing.distance * viewing.monitor_pixels / viewing.monitor_width * pi / 180;
}

SensitivityFilters sensitivity_filters(double pixels_per_degree) {
    constexpr double widest = 0.04; // the largest b below; all three filters have its radius, 3 sigma
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    return {normalised({{1, 0.0047}}, radius, pixels_per_degree),
            normalised({{1, 0.0053}}, radius, pixels_per_degree),
            normalised({{34.1, widest}, {13.5, 0.025}}, radius, pixels_per_degree)};
}

FeatureFilters feature_filters(double pixels_per_degree) {
    constexpr double width = 0.082; // degrees between peak and trough of the edge detector: 2 sigma
    const double sigma = 0.5 * width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    const std::vector<double> smooth = samples(radius, gaussian);
    return {scaled(smooth, 1 / sum(smooth)),
            balanced(samples(radius, [&](double x) { return -x * gaussian(x); })),
            balanced(samples(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); }))};
}

} // namespace analysis
