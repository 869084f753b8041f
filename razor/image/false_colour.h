// Numbers as colours, for looking at layers.
#pragma once

#include "razor/image/image.h"

#include <glm/vec3.hpp>

#include <functional>

namespace razor {

/// As a display shows it, sRGB in [0, 1], of a number in [0, 1] (others are cut off): from dark blue over
/// green and pink to nearly white. Cubehelix (Green, "A colour scheme for the display of astronomical
/// intensity images", 2011) between 0.15 and 0.95 of its fraction l, so that black is no value:
/// l + l (1 - l) / 2 (c cos p + s sin p), p = 2 pi (1 / 6 - 3 l / 2), c = (-0.14861, -0.29227, 1.97294),
/// s = (1.78277, -0.90649, 0), cut off to [0, 1]. Lightness grows all the way, also in grey.
glm::vec3 false_colour(double x);

/// Of a whole number that is a name: hues at steps of the golden ratio, so that neighbours differ; lightness
/// and saturation at steps of two other irrational numbers.
glm::vec3 name_colour(double number);

/// Least and largest.
struct ValueRange {
    double low = 0, high = 1;
};
/// Of the values that are finite and not `missing` (names always are where there is none); 0 to 1 if there
/// are none. A single value is its own low and high.
ValueRange range_of(const Plane& plane, const std::function<bool(float)>& missing);

/// The plane in colours: a film of R, G and B that write_png() with the default tone shows as these, off by 1
/// of 255 at most. `names`: by name_colour(), else low to high by false_colour(). Black: what is missing, or
/// no finite number.
Film false_coloured(const Film& film, const Plane& plane, bool names, const ValueRange& range,
                    const std::function<bool(float)>& missing);

} // namespace razor
