// Curves from samples of lines and from stretches of a trace, against exact ones.
#include "analysis/traces/line_filter.h"
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/sampled_curve.h"
#include "tests/analysis/plain_caches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <span>

namespace analysis {
namespace {

using test::plain_distances;
using test::random_lines;

/// Of lines near each other and far apart, of rates from none to all.
TEST(LinesBelow, AreThoseThatHashBelowTheLimit) {
    std::mt19937_64 random(4);
    for (const double rate : {0.0, 0.01, 0.3, 1.0})
        for (int trial = 0; trial < 50; ++trial) {
            const std::uint64_t offset = trial == 0 ? 0 : random();
            const auto limit = static_cast<std::uint64_t>(rate * 0x1p53);
            std::vector<std::uint64_t> lines(filtered_lines);
            for (std::uint64_t& line : lines)
                line = random() >> (trial % 64);
            const std::uint64_t below = lines_below(lines.data(), offset, limit);
            for (std::size_t i = 0; i < lines.size(); ++i)
                EXPECT_EQ((below >> i & 1U) != 0, traces::hash_bits_of_line(lines[i] + offset) < limit);
        }
}

TEST(Shards, AtRateOneIsExact) {
    const std::vector<std::uint64_t> sizes = {1, 4, 16, 64, 256, 1024};
    const std::vector<std::uint64_t> touches = random_lines(20000, 500, 3, true);
    LruCurve exact(sizes);
    Shards shards(sizes, 1);
    for (const std::uint64_t line : touches) {
        exact.touch(line, 0);
        shards.touch(line, 0);
    }
    EXPECT_EQ(shards.sampled(), touches.size());
    for (std::size_t s = 0; s < sizes.size(); ++s)
        EXPECT_DOUBLE_EQ(shards.estimate(0, s).ratio, static_cast<double>(exact.counts().misses(0, s)) /
                                                          static_cast<double>(touches.size()));
}

/// Many lines, popular by Zipf's law: the estimate is near, and its error as often larger than said as it
/// should.
TEST(Shards, IsNearAndKnowsItsError) {
    const std::vector<std::uint64_t> sizes = {1 << 8, 1 << 10, 1 << 12, 1 << 14, 1 << 16};
    std::vector<double> cumulative;
    double sum = 0;
    for (int i = 1; i <= 100000; ++i)
        cumulative.push_back(sum += 1 / std::pow(i, 0.7));
    int within = 0, all = 0;
    double worst_mean = 0;
    for (std::uint64_t trial = 0; trial < 12; ++trial) {
        std::mt19937_64 random(trial);
        std::uniform_real_distribution<double> uniform(0, sum);
        LruCurve exact(sizes);
        Shards shards(sizes, 0.02);
        constexpr int touches = 300000;
        for (int i = 0; i < touches; ++i) {
            const auto rank = static_cast<std::uint64_t>(
                std::lower_bound(cumulative.begin(), cumulative.end(), uniform(random)) - cumulative.begin());
            const std::uint64_t line = (rank + trial * 1000003) * 0x9E3779B97F4A7C15U >> 20U;
            exact.touch(line, 0);
            shards.touch(line, 0);
        }
        double mean = 0;
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const double truth = static_cast<double>(exact.counts().misses(0, s)) / touches;
            const double error = std::abs(shards.estimate(0, s).ratio - truth);
            mean += error / static_cast<double>(sizes.size());
            within += error <= shards.estimate(0, s).error ? 1 : 0;
            ++all;
        }
        worst_mean = std::max(worst_mean, mean);
    }
    EXPECT_LT(worst_mean, 0.06);
    EXPECT_GE(within, all * 8 / 10);
}

/// So many lines, popular by Zipf's law.
std::vector<std::uint64_t> popular_lines(std::size_t count, int lines, std::uint64_t seed) {
    std::vector<double> cumulative;
    double sum = 0;
    for (int i = 1; i <= lines; ++i)
        cumulative.push_back(sum += 1 / std::pow(i, 0.7));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0, sum);
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto rank = static_cast<std::uint64_t>(
            std::lower_bound(cumulative.begin(), cumulative.end(), uniform(random)) - cumulative.begin());
        out.push_back((rank + seed * 1000003) * 0x9E3779B97F4A7C15U >> 20U);
    }
    return out;
}

TEST(Shards, OfAFixedSizeIsExactWhileAllFits) {
    const std::vector<std::uint64_t> sizes = {1, 4, 16, 64, 256, 1024};
    const std::vector<std::uint64_t> touches = random_lines(20000, 500, 3, true);
    LruCurve exact(sizes);
    Shards shards(sizes, 1, 1, 1600);
    for (const std::uint64_t line : touches) {
        exact.touch(line, 0);
        shards.touch(line, 0);
    }
    EXPECT_EQ(shards.rate(), 1);
    for (std::size_t s = 0; s < sizes.size(); ++s) {
        EXPECT_NEAR(shards.estimate(0, s).ratio,
                    static_cast<double>(exact.counts().misses(0, s)) / static_cast<double>(touches.size()),
                    1e-12);
        EXPECT_EQ(shards.estimate(0, s).error, 0);
    }
}

/// The sample never has more lines, its rate is that of the lines that are in, and it is near.
TEST(Shards, OfAFixedSizeIsNearAndKnowsItsError) {
    const std::vector<std::uint64_t> sizes = {1 << 10, 1 << 12, 1 << 14, 1 << 16};
    int within = 0, all = 0;
    double mean = 0;
    for (std::uint64_t trial = 0; trial < 8; ++trial) {
        const std::vector<std::uint64_t> touches = popular_lines(400000, 100000, trial);
        constexpr std::uint64_t most = 3200;
        LruCurve exact(sizes);
        Shards shards(sizes, 1, 1, most);
        for (const std::uint64_t line : touches) {
            exact.touch(line, 0);
            shards.touch(line, 0);
            ASSERT_LE(shards.lines(), most);
        }
        EXPECT_GT(shards.lines(), most * 99 / 100);
        EXPECT_NEAR(shards.rate(), static_cast<double>(most) / static_cast<double>(exact.lines()),
                    0.1 * shards.rate());
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const double truth =
                static_cast<double>(exact.counts().misses(0, s)) / static_cast<double>(touches.size());
            const double error = std::abs(shards.estimate(0, s).ratio - truth);
            mean += error;
            within += error <= shards.estimate(0, s).error ? 1 : 0;
            ++all;
        }
    }
    EXPECT_LT(mean / all, 0.025);
    EXPECT_GE(within, all * 8 / 10);
}

/// What is looked at is what caches of the whole trace miss, as far as it is known: counted plainly.
TEST(ShortReuse, KnowsWhatSmallCachesMiss) {
    const std::vector<std::uint64_t> sizes = {1, 2, 5, 20, 64};
    const std::vector<std::uint64_t> touches = random_lines(60000, 400, 6, true);
    const std::vector<std::uint64_t> distances = plain_distances(touches);
    constexpr std::uint64_t stretch = 1000;
    ShortReuse all(sizes, 1, stretch); // all stretches, one after the other
    for (std::size_t i = 0; i < touches.size(); ++i)
        all.touch(touches[i], i % 2);
    EXPECT_EQ(all.stretches(), touches.size() / stretch);
    for (std::size_t group = 0; group < 2; ++group)
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            std::uint64_t known = 0, misses = 0;
            for (std::size_t begin = 0; begin < touches.size(); begin += stretch) {
                std::set<std::uint64_t> seen;
                for (std::size_t i = begin; i < begin + stretch; ++i) {
                    if (seen.size() >= sizes[s] && i % 2 == group) {
                        ++known;
                        misses += distances[i] == 0 || distances[i] > sizes[s] ? 1 : 0;
                    }
                    seen.insert(touches[i]);
                }
            }
            const ShortReuse::Estimate got = all.estimate(group, s);
            EXPECT_EQ(got.references, known);
            EXPECT_DOUBLE_EQ(got.ratio, static_cast<double>(misses) / static_cast<double>(known));
        }
}

TEST(ShortReuse, IsNearAndKnowsItsError) {
    const std::vector<std::uint64_t> sizes = {4, 16, 64, 256};
    int within = 0, all = 0;
    for (std::uint64_t trial = 0; trial < 10; ++trial) {
        const std::vector<std::uint64_t> touches = popular_lines(300000, 3000, trial);
        LruCurve exact(sizes);
        ShortReuse stretches(sizes, 0.05, 1500);
        for (const std::uint64_t line : touches) {
            exact.touch(line, 0);
            stretches.touch(line, 0);
        }
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const double truth =
                static_cast<double>(exact.counts().misses(0, s)) / static_cast<double>(touches.size());
            const ShortReuse::Estimate e = stretches.estimate(0, s);
            ASSERT_GT(e.references, 0U);
            EXPECT_NEAR(e.ratio, truth, 0.03);
            within += std::abs(e.ratio - truth) <= e.error ? 1 : 0;
            ++all;
        }
    }
    EXPECT_GE(within, all * 8 / 10);
}

/// Small caches and large ones: each from the sample that sees it; errors are not told where nothing is
/// known.
TEST(SampledCurve, IsNearForCachesOfAllSizes) {
    std::vector<std::uint64_t> sizes;
    for (unsigned shift = 2; shift < 17; ++shift)
        sizes.push_back(std::uint64_t{1} << shift);
    const std::vector<std::uint64_t> touches = popular_lines(2000000, 60000, 1);
    LruCurve exact(sizes);
    SampledCurve rate(sizes, 0.05), size(sizes, 1, 1, 6400), part(sizes, 0.05, 0.9);
    for (const std::uint64_t line : touches) {
        exact.touch(line, 0);
        rate.touch(line, 0);
        size.touch(line, 0);
        part.touch(line, 0);
    }
    for (const SampledCurve* curve : {&rate, &size}) {
        double mean = 0;
        bool lines = false, stretches = false;
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const auto e = curve->estimate(0, s);
            mean += std::abs(e.ratio - static_cast<double>(exact.counts().misses(0, s)) /
                                           static_cast<double>(touches.size()));
            lines = lines || e.of_lines;
            stretches = stretches || !e.of_lines;
            EXPECT_FALSE(std::isnan(e.error)) << sizes[s];
        }
        EXPECT_LT(mean / static_cast<double>(sizes.size()), 0.01);
        EXPECT_TRUE(lines && stretches);
    }
    EXPECT_TRUE(std::isnan(part.estimate(0, 0).error)); // no stretches of a sample
    EXPECT_FALSE(std::isnan(part.estimate(0, sizes.size() - 1).error));
}

/// Of a trace that has room for but a few long stretches short ones tell of small caches.
TEST(SampledCurve, KnowsSmallCachesOfShortTraces) {
    const std::vector<std::uint64_t> sizes = {4, 8, 16, 32};
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const std::vector<std::uint64_t> touches = popular_lines(250000, 20000, seed);
        LruCurve exact(sizes);
        SampledCurve sampled(sizes, 0.05, 1, 0, seed);
        for (const std::uint64_t line : touches)
            exact.touch(line, 0);
        sampled.touch(touches, 0);
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const auto e = sampled.estimate(0, s);
            EXPECT_FALSE(e.of_lines) << sizes[s];
            EXPECT_LT(e.error, 0.05) << sizes[s];
            EXPECT_NEAR(e.ratio, static_cast<double>(exact.counts().misses(0, s)) / 250000, 0.03) << sizes[s];
        }
    }
}

/// Runs of touches of one line among others, together and one by one, in pieces of all lengths.
TEST(SampledCurve, TouchesTogetherAreThoseOneByOne) {
    const std::vector<std::uint64_t> sizes = {16, 64, 256, 1024, 8192};
    std::vector<std::uint64_t> touches;
    std::mt19937_64 random(9);
    for (const std::uint64_t line : random_lines(60000, 3000, 5, true))
        touches.insert(touches.end(), random() % 3 == 0 ? 1 + random() % 40 : 1, line);
    for (const std::uint64_t most : {0U, 400U}) {
        const double rate = most == 0 ? 0.05 : 1;
        SampledCurve single(sizes, rate, 1, most), together(sizes, rate, 1, most);
        for (std::size_t i = 0; i < touches.size();) {
            const std::size_t group = random() % 2;
            const std::size_t n = std::min<std::size_t>(touches.size() - i, random() % 700);
            const std::span<const std::uint64_t> piece(touches.data() + i, n);
            for (const std::uint64_t line : piece)
                single.touch(line, group);
            together.touch(piece, group);
            i += n;
        }
        EXPECT_GT(single.lines().sampled(), 1000U);
        EXPECT_EQ(together.lines().sampled(), single.lines().sampled());
        EXPECT_EQ(together.lines().lines(), single.lines().lines());
        for (std::size_t group = 0; group < 2; ++group)
            for (std::size_t s = 0; s < sizes.size(); ++s) {
                EXPECT_EQ(together.lines().references(group), single.lines().references(group));
                EXPECT_EQ(together.estimate(group, s).ratio, single.estimate(group, s).ratio);
                EXPECT_EQ(together.estimate(group, s).of_lines, single.estimate(group, s).of_lines);
            }
    }
}

/// A trace that holds a tenth of all lines says what the whole one would.
TEST(Shards, OfASampledTrace) {
    const std::vector<std::uint64_t> sizes = {16, 64, 256, 1024};
    const std::vector<std::uint64_t> touches = random_lines(200000, 2000, 9, false);
    LruCurve exact(sizes);
    Shards whole(sizes, 0.3), part(sizes, 0.3, 0.3);
    for (const std::uint64_t line : touches) {
        exact.touch(line, 0);
        whole.touch(line, 0);
        if (traces::hash_of_line(line) < 0.3)
            part.touch(line, 0);
    }
    EXPECT_EQ(whole.sampled(), part.sampled());
    for (std::size_t s = 0; s < sizes.size(); ++s)
        EXPECT_NEAR(part.estimate(0, s).ratio,
                    static_cast<double>(exact.counts().misses(0, s)) / static_cast<double>(touches.size()),
                    0.05);
}

} // namespace
} // namespace analysis
