// Bias and noise of pictures whose bias and noise are known.
#include "analysis/metrics/error_parts.h"
#include "analysis/metrics/hit_differences.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace analysis {
namespace {

constexpr int side = 24;

/// truth + offset + noise of that deviation, independent for each value.
LinearImage picture(std::mt19937& random, double offset, double deviation) {
    LinearImage out(side, side);
    std::normal_distribution<double> noise(0, 1);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t p = 0; p < out.size(); ++p) {
            // Bright places have more noise, and the offset has either sign.
            const double truth = 1 + std::sin(0.3 * static_cast<double>(p)), sign = p % 2 == 0 ? 1 : -1;
            out.planes[c][p] = static_cast<float>(truth + sign * offset + deviation * truth * noise(random));
        }
    return out;
}

std::vector<LinearImage> pictures(std::mt19937& random, int count, double offset, double deviation) {
    std::vector<LinearImage> out;
    for (int i = 0; i < count; ++i)
        out.push_back(picture(random, offset, deviation));
    return out;
}

/// Of picture()'s noise: the mean of (1 + sin)^2.
double noise_factor() {
    double sum = 0;
    for (int p = 0; p < side * side; ++p)
        sum += std::pow(1 + std::sin(0.3 * p), 2);
    return sum / (side * side);
}

struct Case {
    double offset, deviation, reference_deviation;
    int count, references;
};

// Over many trials the estimates' means are right, though the noise is far larger than the bias, and the
// intervals hold the truth nineteen times of twenty.
TEST(ErrorParts, AreUnbiasedAndKnowTheirUncertainty) {
    std::mt19937 random(7);
    const std::vector<bool> all(side * side, true);
    for (const Case& c : {Case{0.02, 0.3, 0.05, 4, 3}, Case{0, 0.3, 0.3, 4, 4}, Case{0.2, 0.05, 0.2, 6, 5},
                          Case{0.1, 0.2, 0, 5, 1}}) {
        SCOPED_TRACE(c.offset);
        const double bias = c.offset * c.offset, variance = c.deviation * c.deviation * noise_factor();
        constexpr int trials = 300;
        double bias_mean = 0, bias_square = 0, variance_mean = 0;
        int within = 0, variance_within = 0;
        for (int t = 0; t < trials; ++t) {
            const auto x = pictures(random, c.count, c.offset, c.deviation),
                       y = pictures(random, c.references, 0, c.reference_deviation);
            const ErrorParts parts = error_parts(x, y, all);
            bias_mean += parts.bias_squared.value / trials;
            bias_square += parts.bias_squared.value * parts.bias_squared.value / trials;
            variance_mean += parts.variance.value / trials;
            within += std::abs(parts.bias_squared.value - bias) <= parts.bias_squared.half_width ? 1 : 0;
            variance_within += std::abs(parts.variance.value - variance) <= parts.variance.half_width ? 1 : 0;
        }
        const double error = std::sqrt((bias_square - bias_mean * bias_mean) / trials);
        EXPECT_NEAR(bias_mean, bias, 4 * error);
        EXPECT_NEAR(variance_mean, variance, 0.01 * variance);
        EXPECT_GT(within, 0.92 * trials);
        EXPECT_GT(variance_within, 0.9 * trials);
        // Without taking the noise's share away it would be far off.
        if (c.deviation > 0.2) {
            EXPECT_LT(4 * error, 0.2 * variance / c.count);
        }
    }
}

// What both have in common is no noise of their difference.
TEST(ErrorParts, OfDifferencesNeedNoReference) {
    std::mt19937 random(3);
    std::vector<LinearImage> differences;
    for (int i = 0; i < 4; ++i) {
        const std::mt19937 same = random;
        std::mt19937 a = same, b = same;
        LinearImage one = picture(a, 0.01, 0.5);
        const LinearImage other = picture(b, 0, 0.5);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t p = 0; p < one.size(); ++p)
                one.planes[c][p] -= other.planes[c][p];
        differences.push_back(one);
        random.discard(100000);
    }
    const ErrorParts parts = error_parts(differences, {}, std::vector<bool>(side * side, true));
    EXPECT_NEAR(parts.bias_squared.value, 1e-4, 1e-8);
    EXPECT_LT(parts.bias_squared.half_width, 1e-8);
}

TEST(ErrorParts, SaysWhenPicturesAreTooFew) {
    std::mt19937 random(1);
    const std::vector<bool> all(side * side, true), none(side * side, false);
    const auto two = pictures(random, 2, 0, 0.1);
    EXPECT_TRUE(std::isnan(error_parts(std::span(two).first(1), two, all).bias_squared.value));
    EXPECT_TRUE(std::isnan(error_parts(two, two, none).bias_squared.value));
    EXPECT_FALSE(std::isnan(error_parts(two, two, all).bias_squared.value));
    EXPECT_TRUE(std::isnan(error_parts(two, two, all).bias_squared.half_width));
}

TEST(ErrorParts, LeavesOutWhatIsNotCounted) {
    std::mt19937 random(1);
    auto x = pictures(random, 3, 0, 0.1);
    std::vector<bool> counted(side * side, true);
    const double before = error_parts(x, {}, counted).variance.value;
    x[0].planes[1][5] = std::numeric_limits<float>::quiet_NaN();
    counted[5] = false;
    EXPECT_NEAR(error_parts(x, {}, counted).variance.value, before, 0.05 * before);
}

ImageFile hits(const std::vector<float>& distances, const std::vector<std::uint32_t>& instances) {
    ImageFile out;
    out.width = static_cast<int>(distances.size());
    out.height = 1;
    out.channels = {{"pick.Z", Channel::Kind::float32, {}},
                    {"pick.instance", Channel::Kind::uint32, instances}};
    for (const float z : distances)
        out.channels[0].bits.push_back(std::bit_cast<std::uint32_t>(z));
    return out;
}

TEST(HitDifferences, TellsWrongHitsFromDistances) {
    constexpr float far = std::numeric_limits<float>::infinity();
    constexpr std::uint32_t no = 0xffffffff;
    const ImageFile a = hits({1.1F, 2, 3, far, far, 4}, {0, 1, 2, no, no, 3});
    const ImageFile b = hits({1, 2, 3, far, 5, 2}, {0, 1, 7, no, 2, 3});
    const HitDifferences d = hit_differences(a, b);
    EXPECT_EQ(d.pixels, 6U);
    EXPECT_EQ(d.wrong, 2U); // the third and the fifth
    EXPECT_NEAR(d.mean_distance_error, (0.1 + 0 + 1) / 3, 1e-6);
    EXPECT_NEAR(d.median_distance_error, 0.1, 1e-6);
    EXPECT_TRUE(std::isnan(hit_differences(hits({far}, {no}), hits({far}, {no})).mean_distance_error));
    EXPECT_THROW(hit_differences(a, hits({1}, {0})), ImageError);
    EXPECT_THROW(hit_differences(a, ImageFile{6, 1, {}}), ImageError);
}

} // namespace
} // namespace analysis
