// One surface per ray has no hole and is what its stand-ins show; the ways it is compared with have holes.
#include "tests/reference/experiment.h"

#include <gtest/gtest.h>

namespace razor::reference {
namespace {

Counts sum_over(Setting s, const std::string& scheme, const std::vector<double>& growths,
                const std::vector<double>& footprints) {
    Counts sum;
    for (s.growth = 0; double growth : growths) {
        s.growth = growth;
        for (double w0 : footprints) {
            s.w0 = w0;
            sum.add(run(s, {scheme}).schemes[scheme]);
        }
    }
    return sum;
}

const std::vector<double> all_growths{-1, -0.1, 0, 0.01, 0.1, 0.4, 0.8, 1.6, 4, 10};

class OneSurface : public testing::TestWithParam<std::tuple<std::string, bool>> {
protected:
    static Setting setting() {
        Setting s;
        std::tie(s.scene, s.random_exponents) = GetParam();
        s.origins = 3;
        s.rays = 24;
        s.e0 = s.random_exponents ? 0.1 : 0.13;
        return s;
    }
    static void expect_none(const Counts& c) {
        EXPECT_GT(c.rays, 0);
        EXPECT_EQ(c.escapes, 0);
        EXPECT_EQ(c.uneven, 0);
        EXPECT_EQ(c.other, 0);
        EXPECT_EQ(c.open, 0);
    }
};

TEST_P(OneSurface, IsClosed) {
    expect_none(sum_over(setting(), "recursive", all_growths, {0, 1}));
}
TEST_P(OneSurface, IsWhatStandInsShow) {
    expect_none(sum_over(setting(), "walk", all_growths, {0.5, 4}));
}
TEST_P(OneSurface, IsWhatLargeStandInsShow) {
    Setting s = setting();
    s.side = 8;
    expect_none(sum_over(s, "walk", {-0.1, 0.1, 0.8}, {1}));
}
TEST_P(OneSurface, HoldsForEveryWidthOfMorph) {
    Setting s = setting();
    s.seed = 2;
    for (double part : {1e-6, 1.0}) {
        s.part = part;
        expect_none(sum_over(s, "walk", {0.1, 0.8}, {1}));
    }
    s.part = 0.25;
    s.cap = 0.25;
    expect_none(sum_over(s, "walk", {1.6}, {1}));
}

INSTANTIATE_TEST_SUITE_P(Cases, OneSurface,
                         testing::Combine(testing::ValuesIn(case_names()), testing::Bool()),
                         [](const auto& info) {
                             return std::get<0>(info.param) + (std::get<1>(info.param) ? "_random" : "");
                         });

Setting many(const std::string& scene, bool random_exponents) {
    Setting s;
    s.scene = scene;
    s.random_exponents = random_exponents;
    s.origins = 8;
    s.rays = 150;
    return s;
}

Setting at_random(const std::string& scene, bool random_exponents) {
    Setting s = many(scene, random_exponents);
    s.aimed = false;
    s.rays = 200;
    return s;
}

// As sound as distances from the origin, but no two rays share it.
TEST(Schemes, FootprintsAtProjectionsAreSoundToo) {
    Setting s = many("torus", true);
    s.rays = 10;
    Counts c = sum_over(s, "projected", {-0.1, 0.1, 0.8}, {1});
    EXPECT_EQ(c.escapes + c.uneven, 0);
}

// A block's box must hold what decides its vertices: ancestors outside the block, where a border is coarser
// than the grid; its own corners, where the surface is displaced.
TEST(Schemes, BoxesOfFinerVerticesAreNotEnough) {
    EXPECT_GT(sum_over(many("torus", true), "finer-box", {0.1}, {0.5, 1}).open, 0);
    EXPECT_GT(sum_over(many("relief", false), "finer-box", {0.1}, {0.5, 1}).open, 0);
}

TEST(Schemes, WithoutSliversRaysPass) {
    Counts c = sum_over(many("sphere", true), "unclosed", {0.1, 0.4}, {1, 4});
    EXPECT_GT(c.uneven, 0);
    EXPECT_GT(c.open, 0);
}

// Not through edges that round apart: no ray is aimed at one.
TEST(Schemes, WholeLevelsLeak) {
    EXPECT_GT(sum_over(at_random("sphere", false), "discrete", {0.4, 0.8}, {1, 4}).escapes, 0);
    EXPECT_GT(sum_over(at_random("torus", true), "patch", {0.8, 1.6}, {0.5, 1}).uneven, 0);
}

TEST(Schemes, OnePairOfLevelsAtATimeLeaks) {
    EXPECT_GT(sum_over(at_random("torus", true), "paper", {0.8}, {0.5, 1}).escapes, 0);
    EXPECT_GT(sum_over(at_random("sphere", false), "printed", {0.4}, {0.5, 1}).escapes, 0);
}

TEST(Schemes, OneViewForAllRaysIsClosed) {
    for (const char* scheme : {"camera", "fixed:0", "fixed:2"}) {
        Counts c = sum_over(many("torus", true), scheme, {0.4}, {1});
        EXPECT_EQ(c.escapes + c.uneven + c.open, 0) << scheme;
    }
}

} // namespace
} // namespace razor::reference
