#include "razor/image/tone.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
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

// AgX's inset, a matrix, is 4/5 of each channel and one mean of all three, of these weights, which sum to
// 1/5: its outset, the inverse, follows.
const glm::vec3 agx_mean(0.04240107095046854F, 0.07843650156180276F, 0.0791624274877287F);
constexpr float agx_kept = 0.8F;
constexpr float agx_least_stops = -12.473931188332413F; // log2(0.18) - 10
constexpr float agx_stops = 16.5F;
constexpr float agx_pivot = 10.0F / 16.5F; // middle grey; shown as 1/2
constexpr float agx_slope = 2;

/// The half of the sigmoid on one side of the pivot: from 0, with agx_slope, to 1/2 at `end`.
float agx_half(float x, float end, float power) {
    // f(x) = s x / (1 + (s x / l)^p)^(1/p), with l so that f(end) = 1/2.
    const float limit = std::pow(std::pow(0.5F, -power) - std::pow(agx_slope * end, -power), -1 / power);
    const float straight = agx_slope * x;
    return straight / std::pow(1 + std::pow(straight / limit, power), 1 / power);
}

float agx_curve(float light) {
    if (!(light > 0))
        return 0;
    const float x = glm::clamp((std::log2(light) - agx_least_stops) / agx_stops, 0.0F, 1.0F);
    const float shown = x < agx_pivot ? 0.5F - agx_half(agx_pivot - x, agx_pivot, 3)
                                      : 0.5F + agx_half(x - agx_pivot, 1 - agx_pivot, 3.25F);
    return glm::clamp(shown, 0.0F, 1.0F);
}

/// What filters make less than black is black, and so is what is no number; squares stay finite.
glm::vec3 shown(glm::vec3 light) {
    for (int c = 0; c < 3; ++c)
        light[c] = light[c] > 0 ? std::min(light[c], 1e9F) : 0;
    return light;
}

glm::vec3 agx(glm::vec3 light) {
    light = light * agx_kept + glm::dot(agx_mean, light);
    const glm::vec3 drawn(agx_curve(light.x), agx_curve(light.y), agx_curve(light.z));
    const glm::vec3 seen = (drawn - glm::dot(agx_mean, drawn)) / agx_kept;
    return glm::pow(glm::clamp(seen, 0.0F, 1.0F), glm::vec3(2.2F)); // what a display makes of it
}

} // namespace

glm::vec3 display_colour(const glm::vec3& light, const Tone& tone) {
    glm::vec3 colour = light * std::exp2(tone.exposure);
    if (tone.curve == ToneCurve::srgb)
        return colour;
    colour = shown(colour);
    if (tone.curve == ToneCurve::agx)
        return agx(colour);
    return glm::clamp(out_of_curve * film_curve(into_curve * colour), 0.0F, 1.0F);
}

} // namespace razor
