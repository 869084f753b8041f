// From scene light to what a display shows.
#pragma once

#include "razor/image/image.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace razor {

enum class ToneCurve : std::uint8_t {
    srgb, // as it is, cut off at 1
    aces  // the film look of the Academy Color Encoding System's reference rendering and sRGB output
};

struct Tone {
    float exposure = 0; // stops: light times 2^exposure
    ToneCurve curve = ToneCurve::srgb;
};

/// Linear sRGB in [0, 1] for display, of linear sRGB light. `aces`: the rational fit of Stephen Hill
/// (BakingLab, 2015), which saturates towards white. What is no number stays none.
glm::vec3 display_colour(const glm::vec3& light, const Tone& tone);

} // namespace razor
