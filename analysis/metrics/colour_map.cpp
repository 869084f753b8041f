#include "analysis/metrics/colour_map.h"

#include <algorithm>
#include <numbers>

namespace analysis {

Colour error_colour(float error) {
    const float t = std::clamp(error, 0.0F, 1.0F);
    // Hue turns from purple through red to yellow; the chroma is the largest of this form within sRGB.
    constexpr float degrees = std::numbers::pi_v<float> / 180;
    const float hue = (295 + 165 * t) * degrees;
    const float chroma = 272 * t * (1 - t);
    Colour rgb = rgb_of_lab({100 * t, chroma * std::cos(hue), chroma * std::sin(hue)});
    for (float& value : rgb) {
        value = std::clamp(value, 0.0F, 1.0F);
    }
    return rgb;
}

} // namespace analysis
