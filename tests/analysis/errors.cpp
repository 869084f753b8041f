// RMSE, relative MSE and MAPE in closed form; pixels that are not numbers.
#include "analysis/metrics/errors.h"

#include "analysis/metrics/finite.h"
#include "tests/analysis/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace analysis {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(Errors, AreZeroOfEqualPictures) {
    const LinearImage image = noise(13, 7, 1, 100);
    const Errors result = errors(image, image, all_of(image));
    EXPECT_EQ(result.pixels, 91U);
    EXPECT_EQ(result.rmse, 0);
    EXPECT_EQ(result.relative_mse, 0);
    EXPECT_EQ(result.mape, 0);
}

TEST(Errors, OfAConstantOffset) {
    const LinearImage reference = constant(9, 5, 0.25F, 0.5F, 1),
                      picture = constant(9, 5, 0.5F, 0.75F, 1.25F);
    const Errors result = errors(picture, reference, all_of(reference));
    EXPECT_NEAR(result.rmse, 0.25, 1e-14);
    const double r = 0.25 / 0.26, g = 0.25 / 0.51, b = 0.25 / 1.01;
    EXPECT_NEAR(result.relative_mse, (r * r + g * g + b * b) / 3, 1e-14);
    EXPECT_NEAR(result.mape, (r + g + b) / 3, 1e-14);
    // Errors are relative to the second picture.
    const Errors swapped = errors(reference, picture, all_of(reference));
    EXPECT_NEAR(swapped.rmse, 0.25, 1e-14);
    EXPECT_NEAR(swapped.mape, (0.25 / 0.51 + 0.25 / 0.76 + 0.25 / 1.26) / 3, 1e-14);
}

TEST(Errors, OfOnePixel) {
    LinearImage reference = constant(4, 3, 0, 0, 0), picture = reference;
    picture.planes[1][5] = -6; // the sign is lost
    const Errors result = errors(picture, reference, all_of(reference));
    EXPECT_NEAR(result.rmse, 6 / std::sqrt(36.0), 1e-14);
    EXPECT_NEAR(result.relative_mse, 360000.0 / 36, 1e-9);
    EXPECT_NEAR(result.mape, 600.0 / 36, 1e-12);
}

// Filters with negative lobes make such references: as black ones.
TEST(Errors, OfReferencesBelowBlack) {
    const LinearImage reference = constant(4, 2, -0.01F, -0.01F, -0.02F);
    const LinearImage picture = constant(4, 2, 0, 0, 0);
    const Errors result = errors(picture, reference, all_of(reference));
    EXPECT_NEAR(result.relative_mse, (1 + 1 + 4) / 3.0, 1e-6);
    EXPECT_NEAR(result.mape, (1 + 1 + 2) / 3.0, 1e-6);
}

TEST(Errors, LeaveOutWhatIsNoNumber) {
    LinearImage reference = constant(4, 2, 1, 1, 1), picture = constant(4, 2, 2, 2, 2);
    picture.planes[0][0] = nan;
    picture.planes[2][0] = infinity; // a pixel with both counts as NaN
    picture.planes[1][3] = -infinity;
    reference.planes[2][3] = nan;
    reference.planes[2][7] = infinity;
    EXPECT_EQ(count_not_finite(picture).nan, 1U);
    EXPECT_EQ(count_not_finite(picture).infinite, 1U);
    EXPECT_EQ(count_not_finite(reference).nan, 1U);
    EXPECT_EQ(count_not_finite(reference).infinite, 1U);
    const std::vector<bool> compared = finite_in_both(picture, reference);
    EXPECT_EQ(compared, (std::vector<bool>{false, true, true, false, true, true, true, false}));
    const Errors result = errors(picture, reference, compared);
    EXPECT_EQ(result.pixels, 5U);
    EXPECT_EQ(result.rmse, 1);
    EXPECT_NEAR(result.mape, 1 / 1.01, 1e-14);
    EXPECT_TRUE(std::isnan(errors(picture, reference, std::vector<bool>(8)).rmse));

    equate_outside(compared, picture, reference);
    EXPECT_EQ(picture.planes[0][0], 1);
    EXPECT_EQ(reference.planes[0][0], 1);
    EXPECT_EQ(picture.planes[2][3], 2); // the reference has none: the picture's
    EXPECT_EQ(picture.planes[2][7], 2);
    EXPECT_EQ(picture.planes[0][1], 2); // others stay
    EXPECT_EQ(reference.planes[0][1], 1);
    for (std::size_t c = 0; c < 3; ++c) {
        for (const std::size_t i : {0U, 3U, 7U}) {
            EXPECT_EQ(picture.planes[c][i], reference.planes[c][i]);
        }
    }
    EXPECT_EQ(count_not_finite(picture).nan + count_not_finite(reference).infinite, 0U);
}

TEST(LinearImage, DecodesDisplayValues) {
    ImageFile file{3, 1, {}};
    file.channels.push_back({"Y", Channel::Kind::uint8, {0, 255, 188}});
    const LinearImage grey = linear_rgb(file, "grey");
    EXPECT_TRUE(is_display_referred(file));
    EXPECT_EQ(grey.planes[0][0], 0);
    EXPECT_EQ(grey.planes[1][1], 1);
    EXPECT_NEAR(grey.planes[2][2], std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
    const ImageFile red{1, 1, {{"R", Channel::Kind::uint8, {0}}}};
    EXPECT_THROW(linear_rgb(red, "red"), ImageError);
    ImageFile wide{2, 1, {}};
    for (const char* name : {"B", "G", "R"}) {
        wide.channels.push_back({name, Channel::Kind::uint16, {65535, 1000}});
    }
    EXPECT_EQ(linear_rgb(wide, "wide").planes[0][0], 1);
    EXPECT_NEAR(linear_rgb(wide, "wide").planes[0][1], 1000 / 65535.0 / 12.92, 1e-9);
}

} // namespace
} // namespace analysis
