// Colour spaces against published values, and the colour map.
#include "analysis/metrics/colour.h"

#include "analysis/metrics/colour_map.h"

#include <gtest/gtest.h>

namespace analysis {
namespace {

void expect_near(const Colour& a, const Colour& b, float tolerance) {
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(a[c], b[c], tolerance) << c;
    }
}

TEST(Colour, LuminanceIsThatOfBt709) {
    EXPECT_NEAR(luminance(1, 0, 0), 0.2126, 1e-4);
    EXPECT_NEAR(luminance(0, 1, 0), 0.7152, 1e-4);
    EXPECT_NEAR(luminance(0, 0, 1), 0.0722, 1e-4);
    EXPECT_NEAR(luminance(1, 1, 1), 1, 1e-12);
}

TEST(Colour, OpponentSpace) {
    expect_near(ycxcz_of_rgb({1, 1, 1}), {100, 0, 0}, 1e-4F);
    expect_near(ycxcz_of_rgb({0, 0, 0}), {-16, 0, 0}, 1e-6F);
    // It is linear but for the offset, and red is at X = 0.4124 / 0.9505, Z = 0.0193 / 1.0890.
    expect_near(ycxcz_of_rgb({1, 0, 0}),
                {116 * 0.2126F - 16, 500 * (0.43388F - 0.21264F), 200 * (0.21264F - 0.01775F)}, 0.02F);
    for (const Colour& rgb : {Colour{1, 0, 0}, Colour{0.2F, 0.7F, 0.1F}, Colour{0, 0, 1}}) {
        expect_near(rgb_of_ycxcz(ycxcz_of_rgb(rgb)), rgb, 1e-5F);
    }
}

TEST(Colour, Cielab) {
    expect_near(lab_of_rgb({1, 1, 1}), {100, 0, 0}, 1e-4F);
    expect_near(lab_of_rgb({0, 0, 0}), {0, 0, 0}, 1e-4F);
    expect_near(lab_of_rgb({1, 0, 0}), {53.24F, 80.09F, 67.20F}, 0.02F);
    expect_near(lab_of_rgb({0, 1, 0}), {87.73F, -86.18F, 83.18F}, 0.02F);
    expect_near(lab_of_rgb({0, 0, 1}), {32.30F, 79.19F, -107.86F}, 0.02F);
    expect_near(lab_of_rgb({0.184187F, 0.184187F, 0.184187F}), {50, 0, 0}, 1e-3F);
    // The straight part near black: L* = 903.3 Y.
    EXPECT_NEAR(lab_of_rgb({0.002F, 0.002F, 0.002F})[0], 1.80659, 1e-4);
    for (const Colour& rgb : {Colour{1, 0, 0}, Colour{0.2F, 0.7F, 0.1F}, Colour{0.001F, 0.002F, 0.003F}}) {
        expect_near(rgb_of_lab(lab_of_rgb(rgb)), rgb, 1e-5F);
    }
}

TEST(Colour, HuntAndHyab) {
    expect_near(hunt({50, 40, -20}), {50, 20, -10}, 1e-5F);
    EXPECT_NEAR(hyab({50, 3, 0}, {40, 0, 4}), 10 + 5, 1e-5);
}

TEST(ColourMap, LightnessIsTheError) {
    EXPECT_EQ(error_colour(0), (Colour{0, 0, 0}));
    expect_near(error_colour(1), {1, 1, 1}, 1e-4F);
    for (int i = 1; i < 1000; ++i) {
        const float t = static_cast<float>(i) / 1000;
        const Colour rgb = error_colour(t);
        const Colour lab = lab_of_rgb(rgb);
        EXPECT_NEAR(lab[0], 100 * t, 0.02); // clamping to the display would change it
        EXPECT_NEAR(std::hypot(lab[1], lab[2]), 272 * t * (1 - t), 0.2);
        EXPECT_LT(rgb[1], 0.98F * std::max(rgb[0], rgb[2]) + 0.02F); // never the green of no number
    }
}

} // namespace
} // namespace analysis
