// Miss ratios from samples of lines, windows and sets: where all is looked at against plainly written caches,
// elsewhere against closed forms.
#include "analysis/traces/estimators.h"
#include "tests/analysis/plain_caches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace analysis {
namespace {

using Lines = std::vector<std::uint64_t>;
using Method = SamplingMethod;

Sampling sampling(Method method, double share, std::uint64_t seed = 0) {
    Sampling out;
    out.method = method;
    out.share = share;
    out.seed = seed;
    out.window = 1000;
    return out;
}

/// In pieces, as blocks of a trace come.
std::unique_ptr<MissEstimator> estimate(const Lines& touches, const Lines& sizes, std::uint64_t ways,
                                        const Sampling& s) {
    auto out = make_estimator(sizes, ways, s);
    for (std::size_t i = 0; i < touches.size(); i += 777)
        out->touch(std::span(touches).subspan(i, std::min<std::size_t>(777, touches.size() - i)));
    return out;
}

TEST(Estimators, ThatLookAtAllAreExact) {
    const Lines sizes = {8, 64, 96, 512}, touches = test::random_lines(20000, 700, 5, true);
    for (const auto& [method, ways] : {std::pair{Method::exact, 0},
                                       {Method::lines, 0},
                                       {Method::windows, 0},
                                       {Method::exact, 4},
                                       {Method::windows, 4},
                                       {Method::sets, 4},
                                       {Method::sets, 8}}) {
        const auto some = estimate(touches, sizes, static_cast<std::uint64_t>(ways), sampling(method, 1, 3));
        for (std::size_t s = 0; s < sizes.size(); ++s) {
            const std::uint64_t w = ways == 0 ? sizes[s] : static_cast<std::uint64_t>(ways);
            EXPECT_DOUBLE_EQ(some->ratio(s),
                             static_cast<double>(test::plain_misses(touches, sizes[s] / w, w, true)) /
                                 static_cast<double>(touches.size()))
                << sampling_method_names[static_cast<std::size_t>(method)] << ", " << ways << " ways, "
                << sizes[s];
        }
        EXPECT_EQ(some->looked_at(), touches.size());
    }
}

/// Lines that come round and round: what windows miss is known.
TEST(Estimators, WindowsBeginAsTheyAreTold) {
    Lines touches;
    for (std::uint64_t i = 0; i < 400000; ++i)
        touches.push_back(i % 100);
    const Lines sizes = {64, 128};
    for (const std::uint64_t ways : {0U, 2U}) {
        Sampling s = sampling(Method::windows, 0.1, 7);
        const auto kept = estimate(touches, sizes, ways, s);
        EXPECT_EQ(kept->looked_at(), 40000U);
        EXPECT_DOUBLE_EQ(kept->ratio(1), 100.0 / 40000);
        s.keep = false;
        const auto empty = estimate(touches, sizes, ways, s);
        EXPECT_EQ(empty->looked_at(), 40000U);
        EXPECT_DOUBLE_EQ(empty->ratio(1), 0.1); // of each window the first hundred
        s.warm_up = 0.05;
        EXPECT_DOUBLE_EQ(estimate(touches, sizes, ways, s)->ratio(1), 50.0 / 950);
        s.warm_up = 0.1;
        EXPECT_DOUBLE_EQ(estimate(touches, sizes, ways, s)->ratio(1), 0);
        if (ways == 0) {
            EXPECT_DOUBLE_EQ(estimate(touches, sizes, ways, s)->ratio(0), 1);
        }
    }
}

/// Half of the trace in each of two ways of behaving: no window is the whole, but each is as likely as
/// others.
TEST(Estimators, SamplesAreNearInTheMeanOverSeeds) {
    Lines touches = test::random_lines(100000, 3000, 11, true);
    for (const std::uint64_t line : test::random_lines(100000, 300, 12, true))
        touches.push_back(line + 10000);
    const Lines sizes = {128, 1024};
    for (const auto& [method, ways] :
         {std::pair{Method::lines, 0}, {Method::windows, 0}, {Method::windows, 4}, {Method::sets, 4}}) {
        const auto w = static_cast<std::uint64_t>(ways);
        const auto exact = estimate(touches, sizes, w, sampling(Method::exact, 1));
        constexpr int seeds = 8;
        const double share = method == Method::windows ? 0.25 : 0.125;
        for (std::size_t size = 0; size < sizes.size(); ++size) {
            double mean = 0, looked_at = 0;
            std::vector<double> all;
            for (int seed = 1; seed <= seeds; ++seed) {
                const auto some =
                    estimate(touches, sizes, w, sampling(method, share, static_cast<std::uint64_t>(seed)));
                all.push_back(some->ratio(size));
                mean += all.back() / seeds;
                looked_at += static_cast<double>(some->looked_at()) / seeds;
            }
            const std::string what = std::string(sampling_method_names[static_cast<std::size_t>(method)]) +
                                     " " + std::to_string(ways) + " " + std::to_string(sizes[size]);
            EXPECT_NEAR(mean, exact->ratio(size), 0.02) << what;
            EXPECT_NEAR(looked_at / static_cast<double>(touches.size()), share, 0.3 * share) << what;
            EXPECT_NE(all[0], all[1]) << what; // another seed, another sample
        }
    }
}

TEST(Estimators, RefuseWhatTheyCannotTell) {
    EXPECT_THROW(make_estimator({64}, 4, sampling(Method::lines, 0.5)), std::invalid_argument);
    EXPECT_THROW(make_estimator({64}, 0, sampling(Method::sets, 0.5)), std::invalid_argument);
    EXPECT_THROW(make_estimator({65}, 4, sampling(Method::exact, 1)), std::invalid_argument);
    EXPECT_TRUE(std::isnan(make_estimator({64}, 0, sampling(Method::windows, 1))->ratio(0)));
}

} // namespace
} // namespace analysis
