#include "razor/image/false_colour.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

double fraction(double x) {
    return x - std::floor(x);
}

/// From what a display is sent to light.
float light_of(double encoded) {
    return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92
                                                 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

std::size_t size_of(const Plane& plane) {
    return plane.ids.empty() ? plane.values.size() : plane.ids.size();
}

bool is_there(const Plane& plane, std::size_t i, const std::function<bool(float)>& missing) {
    if (!plane.ids.empty())
        return plane.ids[i] != no_id;
    return std::isfinite(plane.values[i]) && !missing(plane.values[i]);
}

} // namespace

glm::vec3 false_colour(double x) {
    const double l = 0.15 + 0.8 * std::clamp(x, 0.0, 1.0);
    const double angle = 2 * std::numbers::pi * (1.0 / 6 - 1.5 * l), strength = l * (1 - l) / 2;
    const glm::dvec3 along(-0.14861, -0.29227, 1.97294), across(1.78277, -0.90649, 0);
    return glm::clamp(l + strength * (along * std::cos(angle) + across * std::sin(angle)), 0.0, 1.0);
}

glm::vec3 name_colour(double number) {
    const double hue = fraction(number * (std::numbers::phi - 1) + 0.6);
    const double saturation = 0.45 + 0.4 * fraction(number * std::numbers::sqrt2);
    const double value = 0.6 + 0.4 * fraction(number * std::numbers::sqrt3);
    glm::dvec3 colour;
    for (int c = 0; c < 3; ++c) {
        const double distance = std::abs(fraction(hue + (3 - c) / 3.0) * 6 - 3); // from the opposite hue
        colour[c] = value * (1 - saturation + saturation * std::clamp(distance - 1, 0.0, 1.0));
    }
    return colour;
}

ValueRange range_of(const Plane& plane, const std::function<bool(float)>& missing) {
    ValueRange range{1, 0};
    for (std::size_t i = 0; i < size_of(plane); ++i)
        if (is_there(plane, i, missing)) {
            const bool first = range.low > range.high;
            range.low = first ? plane.at(i) : std::min(range.low, plane.at(i));
            range.high = first ? plane.at(i) : std::max(range.high, plane.at(i));
        }
    return range.low > range.high ? ValueRange{} : range;
}

Film false_coloured(const Film& film, const Plane& plane, bool names, const ValueRange& range,
                    const std::function<bool(float)>& missing) {
    Film colours(film.width, film.height);
    for (const char* name : {"R", "G", "B"})
        colours.add(name);
    const double span = range.high > range.low ? range.high - range.low : 1;
    for (std::size_t i = 0; i < size_of(plane); ++i) {
        if (!is_there(plane, i, missing))
            continue;
        const double value = plane.at(i);
        const glm::vec3 colour = names ? name_colour(value) : false_colour((value - range.low) / span);
        for (std::size_t c = 0; c < 3; ++c)
            colours.planes[c].values[i] = light_of(colour[static_cast<int>(c)]);
    }
    return colours;
}

} // namespace razor
