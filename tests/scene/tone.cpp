// From scene light to display light, beside a plainly written version in double precision and an independent
// fit, and what every curve keeps to.
#include "razor/image/tone.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace razor {
namespace {

using Colour = std::array<double, 3>;

constexpr double inset[3][3] = {{0.8424010709504686, 0.07843650156180276, 0.0791624274877287},
                                {0.04240107095046854, 0.8784365015618028, 0.0791624274877287},
                                {0.04240107095046854, 0.07843650156180276, 0.8791624274877287}};
constexpr double outset[3][3] = {{1.1969986613119143, -0.09804562695225345, -0.09895303435966087},
                                 {-0.053001338688085674, 1.1519543730477466, -0.09895303435966087},
                                 {-0.053001338688085674, -0.09804562695225345, 1.151046965640339}};

Colour times(const double (&m)[3][3], const Colour& v) {
    Colour out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            out[i] += m[i][k] * v[k];
    return out;
}

double in_stops(double light) {
    return std::clamp((std::log2(std::max(light, 1e-300)) - (std::log2(0.18) - 10)) / 16.5, 0.0, 1.0);
}

/// The sigmoid as its author writes it: scaled hyperbolas that meet at the pivot.
double sigmoid(double x) {
    constexpr double pivot = 10 / 16.5, middle = 0.5, slope = 2;
    const bool above = x >= pivot;
    const double power = above ? 3.25 : 3, across = above ? 1 - pivot : pivot,
                 up = above ? 1 - middle : middle;
    double scale =
        std::pow(std::pow(slope * across, -power) * (std::pow(slope * across / up, power) - 1), -1 / power);
    scale = above ? scale : -scale;
    const double term = slope * (x - pivot) / scale;
    return scale * (term / std::pow(1 + std::pow(term, power), 1 / power)) + middle;
}

/// B. Wrensch's fit of the original's table (Minimal AgX Implementation, 2023): mean squared error 3.7e-6.
double fit(double x) {
    return 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
           0.4298 * x * x + 0.1191 * x - 0.00232;
}

Colour plain_agx(const Colour& light) {
    Colour drawn = times(inset, light);
    for (double& c : drawn)
        c = sigmoid(in_stops(c));
    Colour shown = times(outset, drawn);
    for (double& c : shown)
        c = std::pow(std::clamp(c, 0.0, 1.0), 2.2);
    return shown;
}

glm::vec3 shown(const glm::vec3& light, ToneCurve curve = ToneCurve::agx, float exposure = 0) {
    return display_colour(light, {exposure, curve});
}

TEST(Tone, AgxIsWhatItsFormulasSay) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> stops(-16, 8);
    for (int n = 0; n < 20000; ++n) {
        const glm::vec3 light(std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random)));
        const glm::vec3 got = shown(light);
        const Colour expected = plain_agx({light.x, light.y, light.z});
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(got[c], expected[static_cast<std::size_t>(c)], 4e-6) << light.x << ' ' << light.y;
    }
}

TEST(Tone, AgxIsNearTheFitOfItsTable) {
    double squares = 0;
    constexpr int n = 1000;
    for (int i = 0; i <= n; ++i) {
        const double x = double(i) / n, light = std::exp2(16.5 * x + std::log2(0.18) - 10);
        const double grey = std::pow(double{shown(glm::vec3(static_cast<float>(light))).x}, 1 / 2.2);
        squares += (grey - fit(x)) * (grey - fit(x)) / n;
    }
    EXPECT_LT(squares, 1e-5);
    EXPECT_NEAR(shown(glm::vec3(0.18F)).y, std::pow(0.5, 2.2), 1e-6); // middle grey
}

TEST(Tone, CurvesKeepToTheirLimits) {
    constexpr float inf = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float most = std::numeric_limits<float>::max();
    EXPECT_EQ(shown(glm::vec3(0)), glm::vec3(0));
    EXPECT_EQ(shown(glm::vec3(-1)), glm::vec3(0));
    EXPECT_EQ(shown(glm::vec3(nan)), glm::vec3(0));
    EXPECT_EQ(shown(glm::vec3(-inf)), glm::vec3(0));
    for (const float bright : {16.3F, 1e6F, most, inf})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(shown(glm::vec3(bright))[c], 1, 1e-5) << bright;
    for (const float a : {0.0F, -1.0F, 1e-30F, 0.3F, 50.0F, most, inf, nan})
        for (const float b : {0.0F, 2.0F, inf, nan})
            for (int c = 0; c < 3; ++c) {
                const float value = shown({a, b, 0.5F})[c];
                EXPECT_TRUE(value >= 0 && value <= 1) << a << ' ' << b;
            }
    for (const ToneCurve curve : {ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx}) {
        float last = 0;
        for (int i = 0; i <= 4000; ++i) {
            const float light = std::exp2(static_cast<float>(i) * 0.008F - 20);
            const float now = shown(glm::vec3(light), curve).y;
            EXPECT_GE(now, last - 3e-7F) << light;
            last = now;
        }
        EXPECT_EQ(shown(glm::vec3(0.1F), curve, 2), shown(glm::vec3(0.4F), curve));
    }
    // What filters make less than black is black.
    for (const ToneCurve curve : {ToneCurve::aces, ToneCurve::agx})
        for (const float below : {-1e-3F, -0.3F, -4.0F, -inf, nan}) {
            EXPECT_EQ(shown(glm::vec3(below), curve), shown(glm::vec3(0), curve)) << below;
            EXPECT_EQ(shown({below, 0.4F, below}, curve), shown({0, 0.4F, 0}, curve)) << below;
        }
    // Between its ends it rises.
    const auto grey = [](int step) {
        return glm::vec3(0.18F * std::exp2(static_cast<float>(step) * 0.1F - 9.8F));
    };
    for (int i = 0; i < 160; ++i)
        EXPECT_LT(shown(grey(i)).x, shown(grey(i + 1)).x);
}

} // namespace
} // namespace razor
