// Crossings of a solid whose vertices and edges rays meet exactly.
#include "tests/reference/distance.h"
#include "tests/reference/intersect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace razor::reference {
namespace {

/// The octahedron |x| + |y| + |z| <= 4, its faces cut in four, so that all coordinates are small integers.
Soup octahedron() {
    Soup soup;
    auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        int n = static_cast<int>(soup.points.size());
        soup.points.insert(soup.points.end(), {a, b, c});
        soup.triangles.push_back({{n, n + 1, n + 2}, 0, 0, 0, 0, 0, false});
    };
    for (int x : {-4, 4})
        for (int y : {-4, 4})
            for (int z : {-4, 4}) {
                glm::dvec3 a(x, 0, 0), b(0, y, 0), c(0, 0, z);
                glm::dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
                add(a, ab, ca);
                add(b, bc, ab);
                add(c, ca, bc);
                add(ab, bc, ca);
            }
    return soup;
}

double sum_norm(const glm::dvec3& p) {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

TEST(Crossings, EvenThroughVerticesAndEdges) {
    Soup soup = octahedron();
    ASSERT_EQ(open_edges(soup), 0);
    int rays = 0;
    for (int n = 0; n < 9 * 9 * 9; ++n) {
        glm::dvec3 origin(n % 9 - 4, n / 9 % 9 - 4, n / 81 - 4);
        if (sum_norm(origin) == 4)
            continue; // on the surface
        bool inside = sum_norm(origin) < 4;
        for (int m = 0; m < 5 * 5 * 5; ++m) {
            glm::dvec3 direction(m % 5 - 2, m / 5 % 5 - 2, m / 25 - 2);
            if (sum_norm(direction) == 0)
                continue;
            ++rays;
            ASSERT_EQ(crossings({origin, direction}, soup).size() % 2, 0U);
            Hits h = hits({origin, direction}, soup);
            ASSERT_EQ(h.count % 2 == 1, inside);
            if (inside) {
                ASSERT_NEAR(sum_norm(origin + h.nearest.t * direction), 4, 1e-13);
            }
        }
    }
    EXPECT_GT(rays, 80'000);
}

TEST(Crossings, WeightsGiveThePoint) {
    Soup soup = octahedron();
    std::mt19937 random(1);
    for (int n = 0; n < 2000; ++n) {
        Ray ray{{0.3, -0.2, 0.1}, random_direction(random)};
        Hits h = hits(ray, soup);
        ASSERT_GE(h.nearest.triangle, 0);
        const Triangle& t = soup.triangles[static_cast<std::size_t>(h.nearest.triangle)];
        glm::dvec3 p = (1 - h.nearest.along[0] - h.nearest.along[1]) *
                           soup.points[static_cast<std::size_t>(t.points[0])] +
                       h.nearest.along[0] * soup.points[static_cast<std::size_t>(t.points[1])] +
                       h.nearest.along[1] * soup.points[static_cast<std::size_t>(t.points[2])];
        EXPECT_LT(length(p - (ray.origin + h.nearest.t * ray.direction)), 1e-13);
    }
}

// The polyline a - m - b, m at the rounded middle of a and b, and the straight edge: with the sliver between
// them all is closed, and its hits lie on the edge.
TEST(Crossings, SliversCloseAndLieOnTheEdge) {
    std::mt19937 random(2);
    int in_sliver = 0;
    for (int n = 0; n < 20'000; ++n) {
        glm::dvec3 a = random_direction(random);
        glm::dvec3 b = random_direction(random);
        glm::dvec3 m = 0.5 * (a + b);
        glm::dvec3 up = 2.0 * random_direction(random);
        glm::dvec3 down = 2.0 * random_direction(random);
        // The tetrahedron a, b, up, down, its edge a - b halved on the side of `up`.
        Soup soup{{a, b, m, up, down},
                  {{{0, 2, 3}, 0, 0, 0, 0, 0, false},
                   {{2, 1, 3}, 0, 0, 0, 0, 0, false},
                   {{0, 1, 4}, 0, 0, 0, 0, 0, false},
                   {{0, 3, 4}, 0, 0, 0, 0, 0, false},
                   {{1, 3, 4}, 0, 0, 0, 0, 0, false},
                   {{0, 2, 1}, 0, 0, 0, 0, 0, true}}};
        ASSERT_EQ(open_edges(soup), 0);
        double place = uniform(random);
        glm::dvec3 on_edge = a + place * (b - a);
        Ray ray{3.0 * random_direction(random), {}};
        ray.direction = on_edge - ray.origin;
        std::vector<Crossing> found = crossings(ray, soup);
        ASSERT_EQ(found.size() % 2, 0U);
        for (const Crossing& c : found)
            if (c.triangle == 5) {
                ++in_sliver;
                EXPECT_NEAR(c.t, 1, 1e-9);
            }
    }
    EXPECT_GT(in_sliver, 100);
}

} // namespace
} // namespace razor::reference
