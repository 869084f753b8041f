// Pareto fronts against the definition, spreads against closed forms.
#include "analysis/study/pareto.h"
#include "analysis/study/spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace analysis {
namespace {

Trade exact(double x, double y) {
    return {{1, x, x, x, x, 0}, {1, y, y, y, y, 0}};
}

/// By the words of pareto.h, pair by pair.
std::vector<Standing> plain_pareto(const std::vector<Trade>& points) {
    std::vector<Standing> out;
    for (const Trade& p : points) {
        Standing standing =
            std::isnan(p.x.median) || std::isnan(p.y.median) ? Standing::unknown : Standing::front;
        for (const Trade& q : points) {
            if (standing == Standing::unknown || standing == Standing::dominated)
                break;
            const bool as_good = q.x.median <= p.x.median && q.y.median <= p.y.median;
            const bool better = q.x.median < p.x.median || q.y.median < p.y.median;
            if (as_good && better)
                standing =
                    q.x.most < p.x.least || q.y.most < p.y.least ? Standing::dominated : Standing::tied;
        }
        out.push_back(standing);
    }
    return out;
}

TEST(Pareto, IsWhatItsDefinitionSays) {
    std::mt19937 random(1);
    int tied = 0, front = 0, dominated = 0;
    for (int trial = 0; trial < 400; ++trial) {
        std::vector<Trade> points;
        const int count = std::uniform_int_distribution(0, 40)(random);
        // Few values, so that there are equal ones.
        std::uniform_int_distribution value(0, trial % 2 == 0 ? 6 : 1000), spread(0, trial % 3 * 2);
        for (int i = 0; i < count; ++i) {
            Trade p = exact(value(random), value(random));
            for (Spread* s : {&p.x, &p.y}) {
                s->least -= spread(random);
                s->most += spread(random);
            }
            if (value(random) == 0)
                p.y.median = std::numeric_limits<double>::quiet_NaN();
            points.push_back(p);
        }
        const std::vector<Standing> expected = plain_pareto(points);
        ASSERT_EQ(pareto(points), expected) << "trial " << trial;
        tied += static_cast<int>(std::count(expected.begin(), expected.end(), Standing::tied));
        front += static_cast<int>(std::count(expected.begin(), expected.end(), Standing::front));
        dominated += static_cast<int>(std::count(expected.begin(), expected.end(), Standing::dominated));
    }
    EXPECT_GT(tied, 100);
    EXPECT_GT(front, 100);
    EXPECT_GT(dominated, 100);
}

TEST(Pareto, TiesAreSaidToBeTies) {
    std::vector<Trade> points{exact(1, 10), exact(1.01, 10), exact(2, 10)};
    EXPECT_EQ(pareto(points), (std::vector{Standing::front, Standing::dominated, Standing::dominated}));
    points[1].x.least = 0.99; // as fast as the first, on some runs
    EXPECT_EQ(pareto(points), (std::vector{Standing::front, Standing::tied, Standing::dominated}));
}

TEST(Spread, HasMedianEndsAndTheMeansInterval) {
    const double values[] = {4, 1, 3, std::numeric_limits<double>::quiet_NaN(), 2};
    const Spread s = spread_of(values);
    EXPECT_EQ(s.count, 4U);
    EXPECT_EQ(s.median, 2.5);
    EXPECT_EQ(s.least, 1);
    EXPECT_EQ(s.most, 4);
    EXPECT_EQ(s.mean, 2.5);
    // Student's t of 3 degrees of freedom times the standard error.
    EXPECT_NEAR(s.half_width, 3.182446 * std::sqrt(5.0 / 3 / 4), 1e-5);
    EXPECT_EQ(spread_of(std::span(values, 1)).half_width, 0);
    EXPECT_TRUE(std::isnan(spread_of({}).median));
    EXPECT_NEAR(student_t_975(1), 12.7062, 1e-4);
    EXPECT_NEAR(student_t_975(100000), 1.95998, 1e-4);
    EXPECT_TRUE(std::isinf(student_t_975(0)));
}

} // namespace
} // namespace analysis
