// What sampling for a relative error does with noise that is known: made up, pixel by pixel, of random
// numbers.
#include "razor/native/target_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace razor::test {
namespace {

constexpr int side = 128; // pixels
constexpr int tiles = side / tile_side;
constexpr double light = 1; // of every pixel

/// One sample of a pixel in that column.
using Sample = std::function<double(int column, std::mt19937& random)>;

struct Outcome {
    TargetSampling sampling;
    Film film;

    int samples(int column, int row) const {
        return sampling.samples()[static_cast<std::size_t>(row * tiles + column)];
    }
    /// The true relative error, root mean square.
    double error() const {
        double squares = 0;
        for (const float value : film.find("G")->values)
            squares += std::pow((double{value} - light) / (light + 0.01), 2);
        return std::sqrt(squares / static_cast<double>(film.pixel_count()));
    }
};

Outcome take(const Sample& sample, double target, int most, unsigned seed) {
    std::vector<TilePlace> places;
    for (int row = 0; row < tiles; ++row)
        for (int column = 0; column < tiles; ++column)
            places.push_back({column, row});
    const Crop part{0, 0, side, side};
    Outcome o{TargetSampling(places, part, Filter{}, target, most), make_film(side, side)};
    std::mt19937 random(seed);
    std::vector<double> sums(o.film.pixel_count());
    std::vector<int> had(places.size());
    while (o.sampling.next()) {
        for (std::size_t t = 0; t < places.size(); ++t) {
            const int have = o.sampling.samples()[t];
            each_pixel(places[t], part, [&](std::size_t i) {
                for (int s = had[t]; s < have; ++s)
                    sums[i] += sample(static_cast<int>(i) % side, random);
                for (const char* name : {"R", "G", "B"})
                    o.film.find(name)->values[i] = static_cast<float>(sums[i] / have);
            });
            had[t] = have;
        }
        o.sampling.add(o.film);
    }
    return o;
}

// Filters with negative lobes make such pixels beside edges; their errors are those of black ones.
TEST(TargetSampling, TakesLittleForMeansBelowBlack) {
    const Outcome o =
        take([](int, std::mt19937& random) { return std::normal_distribution<double>(-0.01, 1e-4)(random); },
             0.05, 1024, 1);
    for (const int samples : o.sampling.samples())
        EXPECT_EQ(samples, 16);
}

/// Noise of `left` in the left half and of `right` in the right one.
Sample halves(double left, double right) {
    return [=](int column, std::mt19937& random) {
        return std::normal_distribution<double>(light, column < side / 2 ? left : right)(random);
    };
}

TEST(TargetSampling, ReachesTheErrorAndKnowsIt) {
    for (const double target : {0.08, 0.04, 0.02}) {
        const Outcome o = take(halves(0.1, 0.5), target, 4096, 1);
        const PassFigures figures = o.sampling.figures();
        EXPECT_EQ(figures.target, target);
        EXPECT_LE(figures.target_error, target);
        EXPECT_GT(figures.target_error, 0.65 * target) << "more samples than asked for";
        EXPECT_NEAR(figures.target_error, o.error(), 4 * figures.target_error_uncertainty) << target;
        EXPECT_LT(figures.target_error_uncertainty, 0.02 * figures.target_error);
    }
}

/// Over pictures of other samples, estimates lie as far apart as they say, as much more as is stated.
TEST(TargetSampling, KnowsHowSureItIs) {
    double sum = 0, squares = 0, told = 0;
    constexpr int pictures = 40;
    for (unsigned seed = 1; seed <= pictures; ++seed) {
        const PassFigures f =
            take(halves(0.3, 0.5), 1, 4096, seed).sampling.figures(); // two passes, no choice
        EXPECT_EQ(f.samples, pilot_samples);
        sum += f.target_error;
        squares += f.target_error * f.target_error;
        told += f.target_error_uncertainty;
    }
    const double mean = sum / pictures;
    const double apart = std::sqrt((squares / pictures - mean * mean) * pictures / (pictures - 1));
    EXPECT_NEAR(told / pictures / apart, std::sqrt(1.5), 0.35); // its own noise is 11 %
}

TEST(TargetSampling, SpendsSamplesByTheRootOfTheVariance) {
    const double target = 0.02;
    const Outcome o = take(halves(0.2, 0.8), target, 65536, 2);
    // Away from the border between them, where tiles are taken for as noisy as those beside them.
    double left = 0, right = 0;
    for (int row = 0; row < tiles; ++row) {
        left += o.samples(2, row);
        right += o.samples(tiles - 3, row);
    }
    EXPECT_GT(right / left, 2.2); // 4, but for steps of half or all of what there is
    EXPECT_LT(right / left, 6);
    const double uniform = (0.2 * 0.2 + 0.8 * 0.8) / 2 / std::pow(target * (light + 0.01), 2);
    EXPECT_LT(o.sampling.figures().mean_samples, uniform) << "no fewer than everywhere as many";
}

TEST(TargetSampling, RestsWhereThereIsNoNoise) {
    const Outcome quiet = take(halves(0, 0), 0.001, 4096, 3);
    EXPECT_EQ(quiet.sampling.figures().samples, pilot_samples);
    EXPECT_EQ(quiet.sampling.figures().target_error, 0);
    const Outcome half = take(halves(0, 0.5), 0.02, 4096, 3);
    for (int row = 0; row < tiles; ++row)
        EXPECT_EQ(half.samples(0, row), pilot_samples);
    EXPECT_GT(half.samples(tiles - 1, 0), 8 * pilot_samples);
}

/// Where some samples are seen to differ, however little, others may differ more: a quarter of the mean.
TEST(TargetSampling, LeavesNoNoisyTileFarBehind) {
    const Outcome o = take(halves(1e-4, 1), 0.02, 65536, 4);
    EXPECT_GE(o.samples(0, 0), 0.2 * o.sampling.figures().mean_samples);
}

TEST(TargetSampling, TakesNoMoreThanTheMost) {
    const Outcome o = take(halves(0.05, 0.5), 1e-4, 100, 5);
    EXPECT_EQ(o.sampling.figures().samples, 100);
    EXPECT_GT(o.sampling.figures().target_error, 1e-4);
    EXPECT_NEAR(o.sampling.figures().target_error, o.error(),
                4 * o.sampling.figures().target_error_uncertainty);
    EXPECT_NEAR(o.sampling.progress().second, 1, 1e-9);
}

TEST(TargetSampling, LeavesOutWhatIsNoNumber) {
    const Outcome o = take(
        [](int column, std::mt19937& random) {
            return column == 3 ? std::numeric_limits<double>::infinity()
                               : std::normal_distribution<double>(light, 0.5)(random);
        },
        0.05, 4096, 6);
    EXPECT_TRUE(std::isfinite(o.sampling.figures().target_error));
    EXPECT_LE(o.sampling.figures().target_error, 0.05);
}

TEST(TargetSampling, PixelsShareNoiseByTheirFilter) {
    EXPECT_EQ(correlated_pixels(preset_filter(FilterKind::box)), 1);
    Filter triangle = preset_filter(FilterKind::triangle);
    triangle.radius = {1, 1};
    // Overlaps of two triangles a pixel apart, and of one with itself: 1/6 and 2/3.
    EXPECT_NEAR(correlated_pixels(triangle), std::pow(1 + 2.0 / 16, 2), 1e-3);
    Filter wide = preset_filter(FilterKind::box);
    wide.radius = {1, 0.5}; // two pixels wide: overlaps of 2 and 1
    EXPECT_NEAR(correlated_pixels(wide), 1 + 2 * 0.25, 1e-3);
}

} // namespace
} // namespace razor::test
