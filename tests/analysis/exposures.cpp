// Tone curves and the range of exposures of HDR-FLIP.
#include "analysis/metrics/tone_mapping.h"

#include "tests/analysis/pictures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace analysis {
namespace {

constexpr std::array<ToneMapper, 3> mappers{ToneMapper::aces, ToneMapper::hable, ToneMapper::reinhard};

TEST(ToneMapping, CurvesAreThePublishedOnes) {
    for (const double x : {0.0, 0.01, 0.18, 1.0, 4.0, 50.0}) {
        const double y = 0.6 * x;
        EXPECT_NEAR(tone_curve(ToneMapper::aces, x), y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14),
                    1e-12);
        const auto hable = [](double v) {
            return (v * (0.15 * v + 0.10 * 0.50) + 0.20 * 0.02) / (v * (0.15 * v + 0.50) + 0.20 * 0.30) -
                   0.02 / 0.30;
        };
        EXPECT_NEAR(tone_curve(ToneMapper::hable, x), hable(2 * x) / hable(11.2), 1e-12);
        EXPECT_NEAR(tone_curve(ToneMapper::reinhard, x), x / (1 + x), 1e-12);
    }
}

TEST(ToneMapping, InverseUndoesTheCurve) {
    for (const ToneMapper mapper : mappers) {
        EXPECT_EQ(inverse_tone_curve(mapper, 0), 0);
        for (const double y : {1e-6, 0.1, 0.5, 0.85, 0.99}) {
            EXPECT_NEAR(tone_curve(mapper, inverse_tone_curve(mapper, y)), y, 1e-12);
            EXPECT_GT(inverse_tone_curve(mapper, y), 0);
        }
    }
}

TEST(ToneMapping, OfPictures) {
    LinearImage image = constant(2, 1, 1, 2, 4);
    image.planes[0][1] = -1;
    image.planes[1][1] = 1e38F;
    const LinearImage aces = tone_mapped(image, ToneMapper::aces, -1);
    EXPECT_NEAR(aces.planes[1][0], tone_curve(ToneMapper::aces, 1), 1e-7);
    EXPECT_EQ(aces.planes[0][1], 0);
    EXPECT_EQ(aces.planes[1][1], 1);
    const double bright = 0.2126 * 2 + 0.7152 * 4 + 0.0722 * 8;
    EXPECT_NEAR(tone_mapped(image, ToneMapper::reinhard, 1).planes[0][0], 2 / (1 + bright), 1e-4);
}

TEST(Exposures, PutTheBrightestAndTheMedianAtTheirPlaces) {
    LinearImage image = constant(5, 1, 0, 0, 0);
    const std::array<float, 5> greys{0.5F, 64, 0.25F, 8, 1}; // the median is 1
    for (auto& plane : image.planes) {
        std::copy(greys.begin(), greys.end(), plane.begin());
    }
    for (const ToneMapper mapper : mappers) {
        const Exposures range = exposures_of(image, mapper);
        EXPECT_NEAR(tone_curve(mapper, 64 * std::exp2(range.start)), 0.85, 1e-9);
        EXPECT_NEAR(tone_curve(mapper, std::exp2(range.stop)), 0.85, 1e-9);
        EXPECT_NEAR(range.stop - range.start, 6, 1e-9);
        EXPECT_NEAR(range.at(0), range.start, 1e-12);
        EXPECT_NEAR(range.at(range.count - 1), range.stop, 1e-12);
    }
    EXPECT_EQ(exposure_count(-3, -3), 2);
    EXPECT_EQ(exposure_count(0, 2), 2);
    EXPECT_EQ(exposure_count(0, 2.1), 3);
    EXPECT_EQ(exposure_count(-1.5, 4), 6);
}

TEST(Exposures, OfDarkReferences) {
    LinearImage image = constant(10, 10, 0, 0, 0);
    EXPECT_EQ(exposures_of(image, ToneMapper::aces).count, 1);
    EXPECT_EQ(exposures_of(image, ToneMapper::aces).start, 0);
    for (std::size_t i = 0; i < 11; ++i) { // 89 black pixels, the median of the others is 4
        for (auto& plane : image.planes) {
            plane[i] = i < 5 ? 2.0F : i == 5 ? 4.0F : 16.0F;
        }
    }
    const Exposures range = exposures_of(image, ToneMapper::aces);
    EXPECT_NEAR(tone_curve(ToneMapper::aces, 4 * std::exp2(range.stop)), 0.85, 1e-9);
    EXPECT_NEAR(range.stop - range.start, 2, 1e-9);
}

} // namespace
} // namespace analysis
