// FLIP against its plain version, in closed form, and its order of errors.
#include "analysis/metrics/flip.h"

#include "analysis/metrics/compare.h"
#include "analysis/metrics/hdr_flip.h"
#include "tests/analysis/pictures.h"
#include "tests/analysis/plain_flip.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

const double ppd = pixels_per_degree({});

void expect_near(const std::vector<float>& a, const std::vector<double>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_NEAR(a[i], b[i], tolerance) << i;
    }
}

double mean(const std::vector<float>& errors) {
    return pool(errors, std::vector<bool>(errors.size(), true)).mean;
}

/// Smooth shapes with edges, points and colours.
LinearImage scene(int width, int height) {
    LinearImage out(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>(y * width + x);
            const bool inside = (x - width / 2) * (x - width / 2) + (y - height / 2) * (y - height / 2) < 90;
            out.planes[0][i] =
                inside ? 0.8F : 0.1F + 0.5F * static_cast<float>(x) / static_cast<float>(width);
            out.planes[1][i] = inside ? 0.2F : 0.3F;
            out.planes[2][i] = (x % 9 == 4 && y % 7 == 3) ? 1.0F : 0.25F;
        }
    }
    return out;
}

TEST(LdrFlip, EqualsThePlainVersion) {
    const LinearImage reference = scene(41, 33);
    LinearImage picture = scene(41, 33);
    const LinearImage grain = noise(41, 33, 5);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < picture.size(); ++i) {
            picture.planes[c][i] *= 0.7F + 0.8F * grain.planes[c][i];
        }
    }
    for (const double p : {12.0, ppd, 100.0}) {
        expect_near(ldr_flip(picture, reference, p), plain::ldr_flip(picture, reference, p), 3e-5);
    }
    expect_near(ldr_flip(noise(17, 29, 6), noise(17, 29, 7), ppd),
                plain::ldr_flip(noise(17, 29, 6), noise(17, 29, 7), ppd), 3e-5);
    expect_near(ldr_flip(noise(3, 1, 8), noise(3, 1, 9), ppd),
                plain::ldr_flip(noise(3, 1, 8), noise(3, 1, 9), ppd), 3e-5);
}

TEST(LdrFlip, OfEvenColoursInClosedForm) {
    const auto flip = [](const LinearImage& a, const LinearImage& b) {
        const PooledErrors errors = pool(ldr_flip(a, b, ppd), all_of(a));
        EXPECT_NEAR(errors.minimum, errors.maximum, 1e-6);
        return errors.mean;
    };
    const LinearImage black = constant(30, 20, 0, 0, 0), white = constant(30, 20, 1, 1, 1);
    // Black and white are 100 apart; green and blue, the farthest, by CIELAB of sRGB's primaries:
    const double green_blue =
        87.7347 - 32.2970 +
        std::hypot(0.877347 * -86.1827 - 0.322970 * 79.1875, 0.877347 * 83.1793 - 0.322970 * -107.8602);
    const double largest = std::pow(green_blue, 0.7), knee = 0.4 * largest;
    const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - knee) / (largest - knee);
    EXPECT_NEAR(expected, 0.967, 1e-3);
    EXPECT_NEAR(flip(black, white), expected, 1e-5);
    EXPECT_NEAR(flip(constant(30, 20, 0, 1, 0), constant(30, 20, 0, 0, 1)), 1, 1e-6);
    // A grey of L* = 50 is 50 from black, before the knee.
    EXPECT_NEAR(flip(black, constant(30, 20, 0.184187F, 0.184187F, 0.184187F)),
                0.95 * std::pow(50, 0.7) / knee, 5e-5);
    // What a display does not show makes no difference.
    EXPECT_EQ(flip(white, constant(30, 20, 7, 2, 1)), 0);
    EXPECT_EQ(flip(black, constant(30, 20, -1, 0, -3)), 0);
}

TEST(LdrFlip, IsZeroOfEqualPicturesAndSymmetric) {
    const LinearImage a = noise(31, 22, 10), b = noise(31, 22, 11);
    EXPECT_EQ(pool(ldr_flip(a, a, ppd), all_of(a)).maximum, 0);
    EXPECT_EQ(ldr_flip(a, b, ppd), ldr_flip(b, a, ppd));
    EXPECT_GT(mean(ldr_flip(a, b, ppd)), 0.1);
}

TEST(Flip, GrowsWithNoiseAndFallsWithDistance) {
    const LinearImage reference = scene(60, 48), grain = noise(60, 48, 12);
    double before = 0;
    for (const float amount : {0.01F, 0.03F, 0.1F, 0.3F, 0.6F}) {
        LinearImage picture = reference;
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < picture.size(); ++i) {
                picture.planes[c][i] += amount * (grain.planes[c][i] - 0.5F);
            }
        }
        const double near = mean(ldr_flip(picture, reference, ppd));
        EXPECT_GT(near, before);
        EXPECT_LT(mean(ldr_flip(picture, reference, 3 * ppd)), near); // seen from farther away
        const double high = mean(
            hdr_flip(picture, reference, ppd, ToneMapper::aces, exposures_of(reference, ToneMapper::aces)));
        EXPECT_GT(high, 0.5 * before);
        before = near;
    }
}

TEST(HdrFlip, EqualsThePlainVersion) {
    LinearImage reference = scene(40, 30), picture = reference;
    const LinearImage grain = noise(40, 30, 13);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < picture.size(); ++i) {
            reference.planes[c][i] *= i < 200 ? 500.0F : 1.0F; // a bright lamp
            picture.planes[c][i] = reference.planes[c][i] * (0.8F + 0.4F * grain.planes[c][i]);
        }
    }
    picture.planes[1][700] = -0.5F; // as black
    picture.planes[0][800] = 1e30F; // as white
    const Exposures exposures = exposures_of(reference, ToneMapper::aces);
    EXPECT_GE(exposures.count, 8);
    std::vector<double> stops;
    for (int i = 0; i < exposures.count; ++i) {
        stops.push_back(exposures.start + i * (exposures.stop - exposures.start) / (exposures.count - 1));
    }
    expect_near(hdr_flip(picture, reference, ppd, ToneMapper::aces, exposures),
                plain::hdr_flip(picture, reference, ppd, stops), 3e-5);
    // No exposure of a darker picture's differences is lost: more exposures never lower an error.
    const std::vector<float> one =
        hdr_flip(picture, reference, ppd, ToneMapper::aces, {exposures.start, exposures.start, 1});
    const std::vector<float> all = hdr_flip(picture, reference, ppd, ToneMapper::aces, exposures);
    for (std::size_t i = 0; i < one.size(); ++i) {
        ASSERT_LE(one[i], all[i]);
    }
    EXPECT_LT(mean(one), 0.7 * mean(all));
}

TEST(HdrFlip, DoesNotChangeWithTheUnitOfLight) {
    const LinearImage reference = noise(30, 20, 14, 3), picture = noise(30, 20, 15, 3);
    const auto flip = [](const LinearImage& a, const LinearImage& b, ToneMapper mapper) {
        return mean(hdr_flip(a, b, ppd, mapper, exposures_of(b, mapper)));
    };
    const auto scaled = [](const LinearImage& image) {
        return mapped(image, [](float v) { return 1024 * v; });
    };
    for (const ToneMapper mapper : {ToneMapper::aces, ToneMapper::hable, ToneMapper::reinhard}) {
        const double error = flip(picture, reference, mapper);
        EXPECT_NEAR(flip(scaled(picture), scaled(reference), mapper), error, 1e-6);
        EXPECT_GT(error, 0.05);
        EXPECT_GT(std::abs(flip(reference, picture, mapper) - error),
                  1e-5); // the reference sets the exposures
    }
}

ImageFile float_file(const LinearImage& image) {
    ImageFile out{image.width, image.height, {}};
    constexpr std::array<const char*, 3> names{"R", "G", "B"};
    for (const std::size_t c : {2U, 1U, 0U}) {
        Channel& channel = out.channels.emplace_back(Channel{names[c], Channel::Kind::float32, {}});
        for (const float value : image.planes[c]) {
            channel.bits.push_back(std::bit_cast<std::uint32_t>(value));
        }
    }
    return out;
}

TEST(Compare, LeavesPixelsThatAreNoNumbersOutOfFlip) {
    const LinearImage reference = noise(24, 18, 16);
    LinearImage picture = reference;
    picture.planes[1][103] *= 0.5F;
    const ImageFile b = float_file(reference);
    const ImageFile finite = float_file(picture);
    const Comparison expected = compare({finite, "finite"}, {b, "b"}, {});
    EXPECT_GT(expected.flip.maximum, 0.01);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        LinearImage broken = picture;
        broken.planes[0][100] = broken.planes[2][101] = bad;
        const ImageFile a = float_file(broken);
        const Comparison result = compare({a, "a"}, {b, "b"}, {});
        EXPECT_EQ(result.errors.pixels, 24U * 18U - 2);
        EXPECT_NEAR(result.errors.rmse, expected.errors.rmse * std::sqrt(432.0 / 430), 1e-12);
        EXPECT_FALSE(result.differences.identical());
        // Their neighbours have the errors they would have if these pixels were those of the reference.
        for (std::size_t i = 0; i < reference.size(); ++i) {
            if (i == 100 || i == 101) {
                EXPECT_TRUE(std::isnan(result.flip_map[i]));
            } else {
                ASSERT_EQ(result.flip_map[i], expected.flip_map[i]) << i;
            }
        }
    }

    picture = mapped(picture, [](float) { return std::numeric_limits<float>::quiet_NaN(); });
    const ImageFile none = float_file(picture);
    const Comparison nothing = compare({none, "none"}, {b, "b"}, {});
    EXPECT_EQ(nothing.errors.pixels, 0U);
    EXPECT_TRUE(std::isnan(nothing.errors.rmse));
    EXPECT_TRUE(std::isnan(nothing.flip.mean));
}

} // namespace
} // namespace analysis
