// How much surface a picture shows.
#pragma once

#include "razor/image/image.h"
#include "razor/scene/scene.h"

#include <cstdint>

namespace razor {

/// Of the pixels where the film has a surface: how many, and how many squares of a pixel's footprint large
/// what they show is: the sum of 1 / |cosine| between the shading normal and the ray through the pixel's
/// centre. What is seen edge-on, where the normal says little, counts for most_squares.
struct VisibleSurface {
    std::int64_t pixels = 0;
    double squares = 0;
};
inline constexpr double most_squares = 32;
VisibleSurface visible_surface(const Film& film, const Camera& camera, const Settings& settings);

} // namespace razor
