// What adaptive sampling does with noise that is known: made up, pixel by pixel, of random numbers.
#include "razor/native/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace razor::test {
namespace {

constexpr int side = 128; // pixels
constexpr int tiles = side / tile_side;

/// The luminance of one sample of a pixel in that column.
using Sample = std::function<double(int column, std::mt19937& random)>;

struct Outcome {
    AdaptiveSampling sampling;
    Film film;

    int samples(int column, int row) const {
        return sampling.samples()[static_cast<std::size_t>(row * tiles + column)];
    }
    double luminance(std::size_t i) const { return double{film.find("G")->values[i]}; }
};

/// A picture of such pixels.
Outcome take(const Sample& sample, double threshold, int most, unsigned seed) {
    std::vector<TilePlace> places;
    for (int row = 0; row < tiles; ++row)
        for (int column = 0; column < tiles; ++column)
            places.push_back({column, row});
    const Crop part{0, 0, side, side};
    Outcome o{AdaptiveSampling(places, part, threshold, most), make_film(side, side)};
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

/// A mean of 1, noise of `left` in the left half and of `right` in the right one.
Sample halves(double left, double right) {
    return [=](int column, std::mt19937& random) {
        return std::normal_distribution<double>(1, column < side / 2 ? left : right)(random);
    };
}

double error(const Outcome& o) {
    double squares = 0;
    for (std::size_t i = 0; i < o.film.pixel_count(); ++i)
        squares += std::pow(o.luminance(i) - 1, 2);
    return std::sqrt(squares / static_cast<double>(o.film.pixel_count()));
}

TEST(AdaptiveSampling, SpendsSamplesWhereNoiseIs) {
    const double threshold = 0.05;
    const Outcome o = take(halves(0.05, 0.5), threshold, 4096, 1);
    const double needed = std::pow(0.5 / threshold, 2); // 100
    for (int row = 0; row < tiles; ++row)
        for (int column = 0; column < tiles; ++column) {
            if (column < tiles / 2 - 1) { // beside the border tiles wait for their neighbours
                EXPECT_EQ(o.samples(column, row), pilot_samples);
            } else if (column >= tiles / 2) {
                EXPECT_GT(o.samples(column, row), 0.6 * needed);
                EXPECT_LT(o.samples(column, row), 2.1 * needed);
            }
        }
    const PassFigures figures = o.sampling.figures();
    EXPECT_EQ(figures.within_threshold, 1);
    EXPECT_EQ(figures.threshold, threshold);
    EXPECT_LT(figures.mean_samples, 0.75 * needed);
    EXPECT_LE(figures.samples, 2.1 * needed);
}

TEST(AdaptiveSampling, KnowsItsError) {
    for (const double threshold : {0.2, 0.05, 0.02}) {
        const Outcome o = take(halves(0.1, 0.5), threshold, 2048, 2);
        const PassFigures figures = o.sampling.figures();
        EXPECT_NEAR(figures.error / error(o), 1, 0.05) << threshold;
        EXPECT_NEAR(figures.relative_error / figures.error, 1, 0.02);
        EXPECT_LT(figures.error, threshold);
    }
}

TEST(AdaptiveSampling, TakesNoMoreThanTheMost) {
    const Outcome o = take(halves(0.5, 5), 0.05, 50, 3);
    EXPECT_EQ(o.samples(tiles - 1, 0), 50);
    EXPECT_EQ(o.sampling.figures().samples, 50);
    EXPECT_LT(o.sampling.figures().within_threshold, 0.7);
    EXPECT_NEAR(o.sampling.progress().second, 1, 1e-9);
}

/// Light that one sample in 2,000 of a pixel meets: a tile alone misses it in its first samples one time in
/// three and would rest, dark; with its neighbours one in five hundred.
TEST(AdaptiveSampling, IsNotDarkWhereLightIsRare) {
    const Sample rare = [](int, std::mt19937& random) { return random() % 2000 == 0 ? 400.0 : 0.1; };
    const double mean = 0.1 + (400 - 0.1) / 2000;
    int resting = 0;
    double sum = 0, squares = 0;
    constexpr int pictures = 6;
    for (unsigned seed = 0; seed < pictures; ++seed) {
        const Outcome o = take(rare, 0.3, 512, seed);
        double of_picture = 0;
        for (std::size_t i = 0; i < o.film.pixel_count(); ++i)
            of_picture += o.luminance(i) / static_cast<double>(o.film.pixel_count());
        sum += of_picture;
        squares += of_picture * of_picture;
        for (const int samples : o.sampling.samples())
            resting += samples == pilot_samples ? 1 : 0;
    }
    EXPECT_LT(resting, pictures * tiles * tiles / 50);
    const double found = sum / pictures;
    const double off = std::sqrt((squares / pictures - found * found) / (pictures - 1));
    EXPECT_NEAR(found, mean, 0.01 * mean + 3 * off);
}

/// Skewed noise, where what is dark by chance also seems quiet by chance.
TEST(AdaptiveSampling, HasLittleBias) {
    const Sample skewed = [](int, std::mt19937& random) {
        return std::exponential_distribution<double>(1)(random);
    };
    double sum = 0, squares = 0;
    constexpr int pictures = 10;
    for (unsigned seed = 0; seed < pictures; ++seed) {
        const Outcome o = take(skewed, 0.15, 256, seed);
        double of_picture = 0;
        for (std::size_t i = 0; i < o.film.pixel_count(); ++i)
            of_picture += o.luminance(i) / static_cast<double>(o.film.pixel_count());
        sum += of_picture;
        squares += of_picture * of_picture;
    }
    const double found = sum / pictures;
    const double off = std::sqrt((squares / pictures - found * found) / (pictures - 1));
    EXPECT_NEAR(found, 1, 3 * off + 0.001); // the noise of a picture's mean is 0.001
    EXPECT_LT(off, 0.002);
}

TEST(AdaptiveSampling, LeavesOutWhatIsNoNumber) {
    int made = 0;
    const Sample broken = [&](int column, std::mt19937&) {
        return column == 5 && ++made % 9 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
    };
    const Outcome o = take(broken, 0.05, 64, 1);
    EXPECT_EQ(o.sampling.figures().samples, pilot_samples);
    EXPECT_EQ(o.sampling.figures().within_threshold, 1);
}

TEST(AdaptiveSampling, TilesReachBeyondTheirPart) {
    AdaptiveSampling sampling({{1, 1}, {2, 1}}, {12, 9, 5, 3}, 0.1, 32);
    ASSERT_TRUE(sampling.next());
    EXPECT_EQ(sampling.added(), 8 * 5 * 3);
    Film film = make_film(5, 3);
    sampling.add(film);
    ASSERT_TRUE(sampling.next());
    sampling.add(film);
    EXPECT_FALSE(sampling.next());
    EXPECT_EQ(sampling.figures().mean_samples, pilot_samples);
}

} // namespace
} // namespace razor::test
