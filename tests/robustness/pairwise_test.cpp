#include "tests/robustness/pairwise.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace razor::test {
namespace {

TEST(Pairwise, EveryPairIsThere) {
    const std::vector<int> values{6, 2, 5, 5, 3, 4, 2, 5, 3};
    const auto cases = pairwise_cases(values);
    EXPECT_LE(cases.size(), 40U);
    std::size_t pairs = 0;
    for (std::size_t f = 0; f < values.size(); ++f)
        for (std::size_t g = f + 1; g < values.size(); ++g) {
            std::set<std::pair<int, int>> seen;
            for (const auto& c : cases)
                seen.insert({c[f], c[g]});
            pairs += seen.size();
            EXPECT_EQ(seen.size(), static_cast<std::size_t>(values[f] * values[g])) << f << ' ' << g;
        }
    EXPECT_GT(pairs, 500U);
}

} // namespace
} // namespace razor::test
