#include "razor/surface/ear_clipping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace razor::test {
namespace {

using Polygon = std::vector<glm::dvec2>;

double polygon_area(const Polygon& p) { // twice
    double area = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        area += doubled_area(p[0], p[i], p[i + 1]);
    }
    return area;
}

/// No triangle clockwise, areas add up, and every side is used once in its own direction and every diagonal
/// once each way.
void check(const Polygon& p) {
    const auto triangles = clip_ears(p);
    ASSERT_EQ(triangles.size(), p.size() - 2);
    const auto at = [&](int i) { return p[static_cast<std::size_t>(i)]; };
    double area = 0;
    std::map<std::pair<int, int>, int> uses;
    for (const auto& [a, b, c] : triangles) {
        const double this_area = doubled_area(at(a), at(b), at(c));
        EXPECT_GE(this_area, 0);
        area += this_area;
        ++uses[{a, b}];
        ++uses[{b, c}];
        ++uses[{c, a}];
    }
    EXPECT_NEAR(area, polygon_area(p), 1e-12 * std::max(1.0, area));
    const int n = static_cast<int>(p.size());
    for (const auto& [edge, count] : uses) {
        EXPECT_EQ(count, 1);
        const bool is_side = edge.second == (edge.first + 1) % n;
        EXPECT_EQ(uses.count({edge.second, edge.first}), is_side ? 0U : 1U);
    }
    for (int i = 0; i < n; ++i) {
        EXPECT_EQ(uses.count({i, (i + 1) % n}), 1U);
    }
}

TEST(EarClipping, SmallShapes) {
    check({{0, 0}, {1, 0}, {0, 1}});
    check({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    check({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}});
    check({{0.5, 0.5}, {0, 2}, {0, 0}, {2, 0}});
}

TEST(EarClipping, StarShapedPolygons) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> radius(0.05, 1);
    for (int n = 5; n < 200; n += 3) {
        Polygon p;
        for (int i = 0; i < n; ++i) {
            const double r = radius(random), angle = 2 * std::numbers::pi * i / n;
            p.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
        check(p);
    }
}

TEST(EarClipping, CombsAndSpirals) {
    Polygon comb; // teeth of equal height: many points in line
    for (int i = 0; i < 40; ++i) {
        comb.emplace_back(i, i % 2 == 0 ? 0 : 5);
    }
    comb.emplace_back(39, 6);
    comb.emplace_back(0, 6);
    check(comb);
    Polygon spiral;
    constexpr int turns = 60;
    for (int i = 0; i < turns; ++i) {
        const double a = 0.3 * i;
        spiral.emplace_back((1 + 0.2 * a) * std::cos(a), (1 + 0.2 * a) * std::sin(a));
    }
    for (int i = turns - 1; i >= 0; --i) {
        const double a = 0.3 * i;
        spiral.emplace_back((0.8 + 0.2 * a) * std::cos(a), (0.8 + 0.2 * a) * std::sin(a));
    }
    check(spiral);
}

TEST(EarClipping, PointsInLine) {
    Polygon p;
    for (int i = 0; i < 10; ++i) {
        p.emplace_back(i, 0);
    }
    for (int i = 0; i < 10; ++i) {
        p.emplace_back(10, i);
    }
    for (int i = 10; i > 0; --i) {
        p.emplace_back(i, 10);
    }
    check(p);
    Polygon steps;
    for (int i = 0; i < 8; ++i) {
        steps.emplace_back(i, -i);
        steps.emplace_back(i + 1, -i);
    }
    steps.emplace_back(20, 20);
    check(steps);
}

TEST(EarClipping, HoleJoinedByABridge) {
    check({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
    check({{0, 0}, {9, 0}, {9, 4}, {5, 4}, {5, 3}, {3, 3}, {3, 1}, {6, 1}, {6, 3}, {5, 3}, {5, 4}, {0, 4}});
}

TEST(EarClipping, RandomSimplePolygons) {
    // Grown from a triangle by pushing side midpoints to where no side is crossed.
    std::mt19937 random(99);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto crosses = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
        return doubled_area(a, b, c) * doubled_area(a, b, d) <= 0 &&
               doubled_area(c, d, a) * doubled_area(c, d, b) <= 0;
    };
    for (int trial = 0; trial < 40; ++trial) {
        Polygon p{{-1, -1}, {1, -1}, {0, 1}};
        for (int attempt = 0; attempt < 400; ++attempt) {
            const std::size_t n = p.size(), i = random() % n;
            const glm::dvec2 a = p[i], b = p[(i + 1) % n], x{number(random), number(random)};
            bool simple = true;
            for (std::size_t k = 0; k < n && simple; ++k) {
                const glm::dvec2 c = p[k], d = p[(k + 1) % n];
                simple = k == i || ((c == b || d == b || !crosses(x, b, c, d)) &&
                                    (c == a || d == a || !crosses(a, x, c, d)) &&
                                    !(d == a && crosses(x, b, c, d)) && !(c == b && crosses(a, x, c, d)));
            }
            if (simple) {
                p.insert(p.begin() + static_cast<std::ptrdiff_t>(i) + 1, x);
            }
        }
        if (polygon_area(p) < 0) {
            std::reverse(p.begin(), p.end());
        }
        ASSERT_GT(p.size(), 10U);
        check(p);
    }
}

TEST(EarClipping, DegenerateAndCrossingPolygonsEnd) {
    for (const Polygon& p :
         {Polygon(20, {1, 1}), Polygon{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 0}},
          Polygon{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, Polygon{{0, 0}, {1, 0}, {0, 0}, {1, 0}, {0, 0}, {0, 1}}}) {
        EXPECT_EQ(clip_ears(p).size(), p.size() - 2);
    }
}

} // namespace
} // namespace razor::test
