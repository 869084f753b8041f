#include "razor/scene/filter.h"

#include <cmath>
#include <numbers>

namespace razor {
namespace {

double bell(double x, double sigma) {
    return std::exp(-x * x / (2 * sigma * sigma));
}

/// The cubic of Mitchell & Netravali, which ends at 2.
double cubic(double x, double b, double c) {
    if (x <= 1)
        return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) /
           6;
}

double sinc(double x) {
    const double angle = std::numbers::pi * x;
    return std::abs(angle) < 1e-8 ? 1 : std::sin(angle) / angle;
}

} // namespace

double filter_at(const Filter& filter, int axis, double x) {
    const double radius = filter.radius[axis];
    const double away = std::abs(x);
    if (away > radius)
        return 0;
    switch (filter.kind) {
    case FilterKind::box:
        return 1;
    case FilterKind::triangle:
        return radius - away;
    case FilterKind::gaussian:
        return bell(x, filter.sigma) - bell(radius, filter.sigma);
    case FilterKind::mitchell:
        return cubic(2 * away / radius, filter.b, filter.c);
    case FilterKind::lanczos:
        return sinc(x) * sinc(x / filter.tau);
    }
    return 0;
}

} // namespace razor
