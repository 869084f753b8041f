// Weighted quantiles of short lists.
#include "analysis/metrics/pooling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace analysis {
namespace {

TEST(Pooling, WeighsErrorsByThemselves) {
    // In order 0, 0, 0.125, 0.25, 0.5, 0.625: sums 0, 0, 0.125, 0.375, 0.875, 1.5.
    const std::vector<float> errors{0.5F, 0, 0.625F, 0.125F, 0, 0.25F};
    const PooledErrors result = pool(errors, std::vector<bool>(6, true));
    EXPECT_EQ(result.mean, 0.25);
    EXPECT_EQ(result.weighted_first_quartile, 0.5); // 0.375 is not exceeded at 0.25
    EXPECT_EQ(result.weighted_median, 0.5);
    EXPECT_EQ(result.weighted_third_quartile, 0.625);
    EXPECT_EQ(result.minimum, 0);
    EXPECT_EQ(result.maximum, 0.625);
}

TEST(Pooling, CountsOnlyWhatIsCounted) {
    const std::vector<float> errors{0.5F, NAN, 0.25F};
    const PooledErrors result = pool(errors, {true, false, true});
    EXPECT_EQ(result.mean, 0.375);
    EXPECT_EQ(result.maximum, 0.5);
    EXPECT_TRUE(std::isnan(pool(errors, {false, false, false}).weighted_median));
}

TEST(Pooling, OfNoErrors) {
    const PooledErrors result = pool({0, 0, 0}, {true, true, true});
    EXPECT_EQ(result.mean, 0);
    EXPECT_EQ(result.weighted_median, 0);
    EXPECT_EQ(result.maximum, 0);
}

} // namespace
} // namespace analysis
