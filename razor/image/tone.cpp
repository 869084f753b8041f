#include "razor/image/tone.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>

namespace razor {
namespace {

// By columns: linear sRGB to the space in which the curve works, and back.
const glm::mat3 into_curve(0.59719F, 0.07600F, 0.02840F, 0.35458F, 0.90834F, 0.13383F, 0.04823F, 0.01566F,
                           0.83777F);
const glm::mat3 out_of_curve(1.60475F, -0.10208F, -0.00327F, -0.53108F, 1.10813F, -0.07276F, -0.07367F,
                             -0.00605F, 1.07602F);

glm::vec3 film_curve(const glm::vec3& v) {
    const glm::vec3 light = v * (v + 0.0245786F) - 0.000090537F;
    const glm::vec3 most = v * (0.983729F * v + 0.4329510F) + 0.238081F;
    return light / most;
}

} // namespace

glm::vec3 display_colour(const glm::vec3& light, const Tone& tone) {
    glm::vec3 colour = light * std::exp2(tone.exposure);
    if (tone.curve == ToneCurve::srgb)
        return colour;
    colour = glm::min(colour, glm::vec3(1e9F)); // squares stay finite
    return glm::clamp(out_of_curve * film_curve(into_curve * colour), 0.0F, 1.0F);
}

} // namespace razor
