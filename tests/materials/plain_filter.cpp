#include "tests/materials/plain_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor::test {
namespace {

/// Of Mitchell & Netravali's cubics, which are a plane: Hermite's, what b adds (the whole of it makes the
/// B-spline) and what c adds (Keys, Cubic Convolution Interpolation, 1981). x in [0, 2].
double cubics(double x, double b, double c) {
    const double hermite = x < 1 ? 2 * std::pow(x, 3) - 3 * std::pow(x, 2) + 1 : 0;
    const double spline = x < 1 ? 2.0 / 3 - std::pow(x, 2) + std::pow(x, 3) / 2 : std::pow(2 - x, 3) / 6;
    const double keys = x < 1 ? x * x * (1 - x) : (1 - x) * (2 - x) * (2 - x);
    return (1 - b) * hermite + b * spline + c * keys;
}

double sine_over(double x) {
    return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

} // namespace

double PlainFilter::at(int axis, double x) const {
    const double radius = filter_.radius[axis], away = std::abs(x);
    switch (filter_.kind) {
    case FilterKind::box:
        return 1;
    case FilterKind::triangle:
        return 1 - away / radius;
    case FilterKind::gaussian: // lowered, to end at 0
        return std::exp(-std::pow(x / filter_.sigma, 2) / 2) -
               std::exp(-std::pow(radius / filter_.sigma, 2) / 2);
    case FilterKind::mitchell:
        return cubics(2 * away / radius, filter_.b, filter_.c);
    case FilterKind::lanczos:
        return sine_over(x) * sine_over(x / filter_.tau);
    }
    return 0;
}

PlainFilter::PlainFilter(const Filter& filter) : filter_(filter) {
    constexpr int points = 4000;
    for (const int axis : {0, 1}) {
        double whole = 0, size = 0;
        for (int k = 0; k < points; ++k) {
            const double value = at(axis, ((k + 0.5) / points * 2 - 1) * filter.radius[axis]);
            whole += value;
            size += std::abs(value);
        }
        factor_ *= size / whole;
        most_ = std::max(most_, std::abs(at(axis, 0))); // all have their largest value there
    }
}

FilmSample PlainFilter::choose(const std::function<double()>& next) const {
    FilmSample s{{0, 0}, factor_};
    for (const int axis : {0, 1}) {
        double value = 0;
        do {
            s.place[axis] = (next() * 2 - 1) * filter_.radius[axis];
            value = at(axis, s.place[axis]);
        } while (filter_.kind != FilterKind::box && next() * most_ >= std::abs(value));
        s.factor *= value < 0 ? -1 : 1;
    }
    return s;
}

} // namespace razor::test
