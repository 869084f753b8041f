// The steepest chord of a block: no line between two of its points is steeper than is said, wherever rays see
// its vertices; sheets of which nothing can be said are known; and rays that leave by a steeper way are not
// tested against it.
#include "tests/kernels/cages.h"
#include "tests/kernels/chords_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(chords, ChordArguments&)

namespace {

constexpr float never = 2; // no direction is as steep

using Target = TargetFunction<ChordArguments&>;

/// Vertices of quads_u x quads_v quads, row by row.
struct Sheet {
    int quads_u, quads_v;
    std::vector<glm::dvec3> vertices;

    template <class Place> Sheet(int u, int v, Place place) : quads_u(u), quads_v(v) {
        for (int j = 0; j <= v; ++j)
            for (int i = 0; i <= u; ++i)
                vertices.push_back(place(static_cast<double>(i) / u, static_cast<double>(j) / v));
    }
    glm::dvec3& at(int i, int j) { return vertices[static_cast<std::size_t>(j * (quads_u + 1) + i)]; }
    const glm::dvec3& at(int i, int j) const {
        return vertices[static_cast<std::size_t>(j * (quads_u + 1) + i)];
    }
    /// A point of its triangles, which (0, 0) and (1, 1) of each quad divide.
    glm::dvec3 point(std::mt19937& random) const {
        std::uniform_real_distribution<double> number(0, 1);
        const int i = static_cast<int>(random() % static_cast<unsigned>(quads_u));
        const int j = static_cast<int>(random() % static_cast<unsigned>(quads_v));
        const double u = number(random);
        const double v = number(random);
        const glm::dvec3& low = at(i, j);
        const glm::dvec3& high = at(i + 1, j + 1);
        return u > v ? low + (u - v) * (at(i + 1, j) - low) + v * (high - low)
                     : low + (v - u) * (at(i, j + 1) - low) + u * (high - low);
    }
};

struct Chords {
    glm::dvec3 normal;
    double slope;
};
Chords measured(const Target& t, const Sheet& s, double sway) {
    const auto n = s.vertices.size();
    const auto stride = (n + 15) / 16 * 16;
    std::vector<float> room(3 * stride + 160); // as of blocks, lanes beyond the last are read by nobody
    void* at = room.data();
    std::size_t bytes = room.size() * sizeof(float);
    auto* x = static_cast<float*>(std::align(64, 3 * stride * sizeof(float), at, bytes));
    for (std::size_t i = 0; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            x[static_cast<std::size_t>(k) * stride + i] = static_cast<float>(s.vertices[i][k]);
    ChordArguments a;
    a.x = x;
    a.stride = static_cast<int>(stride);
    a.quads_u = s.quads_u;
    a.quads_v = s.quads_v;
    a.sway = static_cast<float>(sway);
    t.run(a);
    return {{a.normal[0], a.normal[1], a.normal[2]}, a.slope};
}

/// Of many random chords.
double steepest(const Sheet& s, const glm::dvec3& normal, std::mt19937& random) {
    double most = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 chord = s.point(random) - s.point(random);
        const double length = glm::length(chord);
        if (length > 0)
            most = std::max(most, std::abs(glm::dot(chord, normal)) / length);
    }
    return most;
}

// Bumpy, bent, slanted and sheared sheets of all sizes of blocks; vertices off their places by up to a sway.
TEST(Chords, AreNoSteeperThanIsSaid) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    int known = 0;
    double tightest = 0;
    for (int n = 0; n < 400; ++n) {
        const int u = 1 << random() % 4;
        const int v = 1 << random() % 4;
        const double bumps = 0.3 * number(random);
        const double bend = number(random);
        const glm::dvec3 sideways{0.6 * number(random), 1, 0.5 * number(random)};
        const double fan = 0.5 * number(random);
        const Sheet s(u, v, [&](double x, double y) {
            return glm::dvec3{x * (1 + fan * y), 0,
                              bend * 0.3 * (x - y) * (x - y) + 0.05 * bumps * std::sin(9 * x * y)} +
                   y * sideways;
        });
        const double sway = n % 2 == 0 ? 0 : 0.02 * std::abs(number(random)) / std::max(u, v);
        Sheet moved = s;
        for (glm::dvec3& p : moved.vertices) {
            glm::dvec3 way{number(random), number(random), number(random)};
            p += way * (sway / std::max(glm::length(way), 1.0));
        }
        for (const Target& t : chords_of_targets()) {
            SCOPED_TRACE(std::string(t.name) + ", sheet " + std::to_string(n));
            const Chords c = measured(t, s, sway);
            if (c.slope >= never)
                continue;
            ++known;
            EXPECT_NEAR(glm::length(c.normal), 1, 1e-5);
            const double of_it = steepest(s, c.normal, random);
            EXPECT_LE(of_it, c.slope);
            EXPECT_LE(steepest(moved, c.normal, random), c.slope);
            tightest = std::max(tightest, of_it / c.slope);
        }
    }
    const auto targets = static_cast<int>(chords_of_targets().size());
    EXPECT_GT(known, 200 * targets); // most are known
    EXPECT_GT(tightest, 0.5);
}

TEST(Chords, OfFlatSheetsLieInThem) {
    const Sheet s(8, 8, [](double x, double y) { return glm::dvec3{3 * x + y, 2 * y, x + y}; });
    for (const Target& t : chords_of_targets()) {
        SCOPED_TRACE(t.name);
        const Chords c = measured(t, s, 0);
        EXPECT_LT(c.slope, 1e-4);
        EXPECT_NEAR(glm::dot(c.normal, glm::normalize(glm::cross(glm::dvec3{3, 0, 1}, glm::dvec3{1, 2, 1}))),
                    1, 1e-5);
    }
}

// One side of no length, as about a pole: what has no length leads nowhere.
TEST(Chords, OfPointedSheetsAreKnown) {
    const Sheet s(4, 4, [](double x, double y) {
        return glm::dvec3{(x - 0.5) * y * 0.5, y, 0.02 * x * x * y};
    });
    std::mt19937 random(3);
    for (const Target& t : chords_of_targets()) {
        SCOPED_TRACE(t.name);
        const Chords c = measured(t, s, 0);
        ASSERT_LT(c.slope, 0.1);
        EXPECT_LE(steepest(s, c.normal, random), c.slope);
    }
}

// All of a ramp of more than one turn faces up, and from below one sees the turn above.
TEST(Chords, OfSheetsThatOverlapThemselvesAreNotKnown) {
    const Sheet ramp(8, 2, [](double x, double y) {
        const double a = 2.2 * std::numbers::pi * x;
        return glm::dvec3{(1 + y) * std::cos(a), (1 + y) * std::sin(a), 0.3 * x};
    });
    const Sheet half(8, 2, [](double x, double y) {
        const double a = 0.2 * std::numbers::pi * x;
        return glm::dvec3{(1 + y) * std::cos(a), (1 + y) * std::sin(a), 0.03 * x};
    });
    const Sheet folded(8, 2, [](double x, double y) { return glm::dvec3{std::abs(x - 0.6), y, 0.01 * x}; });
    Sheet nowhere = half;
    nowhere.at(3, 1).y = std::numeric_limits<double>::quiet_NaN();
    Sheet far = half;
    far.at(3, 1).y = std::numeric_limits<double>::infinity();
    const Sheet point(2, 2, [](double, double) { return glm::dvec3{1, 2, 3}; });
    for (const Target& t : chords_of_targets()) {
        SCOPED_TRACE(t.name);
        EXPECT_EQ(measured(t, ramp, 0).slope, never);
        EXPECT_LT(measured(t, half, 0).slope, 0.5);
        EXPECT_EQ(measured(t, folded, 0).slope, never);
        EXPECT_EQ(measured(t, nowhere, 0).slope, never);
        EXPECT_EQ(measured(t, far, 0).slope, never);
        EXPECT_EQ(measured(t, half, 1).slope, never); // vertices may be anywhere
        const Chords of_point = measured(t, point, 0);
        EXPECT_EQ(of_point.normal, (glm::dvec3{0, 0, 0})); // along which no ray rises
        EXPECT_GT(of_point.slope, 0);
    }
}

// A smooth ball, by itself under a light: each packet leaves it, and those that look at the light from well
// above their horizon meet none of the blocks that they leave.
TEST(Chords, SpareRaysTheBlocksTheyLeave) {
    Scene s = scene_of(cube_cage(), 400);
    s.camera.position = {0, 4, 0};
    s.camera.target = {0, 0, 0};
    s.camera.up = {0, 0, 1};
    s.camera.fov_degrees = 8; // its top
    s.lights = {{{-0.5, 6, -0.5}, {1, 0, 0}, {0, 0, 1}, {1, 1, 1}}};
    s.settings.width = s.settings.height = 64;
    s.settings.light_samples = 4;
    s.settings.sky_samples = 0;
    RenderOptions options;
    options.threads = 1;
    const auto tests_of_group = [&](Lod lod) {
        s.settings.lod = lod;
        const RenderResult r = render_native(s, options);
        const Counters& light = r.statistics.frame.by_kind.kind[kind_light];
        EXPECT_EQ(light.rays, 64 * 64 * 4);
        for (const float v : r.film.find("R")->values)
            EXPECT_GT(v, 0);
        return static_cast<double>(light.quad_tests) / static_cast<double>(light.groups);
    };
    // Without, 15 in all cases.
    EXPECT_LT(tests_of_group(Lod::object), 1);
    EXPECT_LT(tests_of_group(Lod::fixed), 1);
    EXPECT_LT(tests_of_group(Lod::camera), 1);
    EXPECT_LT(tests_of_group(Lod::recursive), 8); // some ask for much longer edges away from where they leave
}

} // namespace
} // namespace razor::test
