// How the light about a pixel becomes its value: the filter that the picture is reconstructed with. Kinds,
// parameters and their presets are those of pbrt-v4, section 8.8: products of a function of x and one of y.
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>

namespace razor {

enum class FilterKind : std::uint8_t { box, triangle, gaussian, mitchell, lanczos };

struct Filter {
    FilterKind kind = FilterKind::box;
    glm::dvec2 radius{0.5, 0.5};     // pixels from a pixel's middle: beyond it the filter is 0
    double sigma = 0.5;              // of a gaussian: standard deviation, pixels
    double b = 1.0 / 3, c = 1.0 / 3; // of Mitchell & Netravali's (Reconstruction Filters, SIGGRAPH 1988)
    double tau = 3;                  // of a windowed sinc: the window's first zero, pixels

    bool operator==(const Filter&) const = default;
};

/// pbrt's presets.
constexpr Filter preset_filter(FilterKind kind) {
    Filter f;
    f.kind = kind;
    const double radius = kind == FilterKind::box        ? 0.5
                          : kind == FilterKind::gaussian ? 1.5
                          : kind == FilterKind::lanczos  ? 4
                                                         : 2;
    f.radius = {radius, radius};
    return f;
}

/// Whether each sample counts alike for the pixel that it lies in, and for no other.
constexpr bool is_pixel(const Filter& f) {
    return f.kind == FilterKind::box && f.radius.x == 0.5 && f.radius.y == 0.5;
}

/// The factor of one axis (0: x, 1: y), x pixels from the middle; not normalised.
double filter_at(const Filter& filter, int axis, double x);

} // namespace razor
