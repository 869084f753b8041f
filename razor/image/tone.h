// From scene light to what a display shows.
#pragma once

#include "razor/image/image.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace razor {

enum class ToneCurve : std::uint8_t {
    srgb, // as it is, cut off at 1
    aces, // the film look of the Academy Color Encoding System's reference rendering and sRGB output
    agx   // T. Sobotka's: bright colours fade to white without turning
};

struct Tone {
    float exposure = 0; // stops: light times 2^exposure
    ToneCurve curve = ToneCurve::srgb;
};

/// Linear sRGB in [0, 1] for display, of linear sRGB light. `aces`: the rational fit of Stephen Hill
/// (BakingLab, 2015), which saturates towards white; what is no number stays none.
///
/// `agx`: the base look of AgX (github.com/sobotka/AgX, 2022), by its formulas: a fifth of
/// each channel becomes a mean of all; of the logarithm, from 10 stops below middle grey to 6.5 above, the
/// tunable sigmoid of J. Smith, of slope 2 at middle grey, powers 3 below and 3.25 above it, makes what the
/// display is sent, which is then spread again. Negative light and what is no number count as none; black
/// stays black, and what is as bright as can be is white.
glm::vec3 display_colour(const glm::vec3& light, const Tone& tone);

} // namespace razor
