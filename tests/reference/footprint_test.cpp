// Weights at known footprints, and the order of distances to points and boxes.
#include "tests/reference/cages.h"
#include "tests/reference/distance.h"
#include "tests/reference/footprint.h"

#include <gtest/gtest.h>

namespace razor::reference {
namespace {

TEST(Footprint, GrowsAndIsClamped) {
    Footprint f{2, 0.5, 0.25};
    EXPECT_EQ(f.at(0), 2);
    EXPECT_EQ(f.at(3), 3.5);
    f.growth = -1;
    EXPECT_EQ(f.at(1), 1);
    EXPECT_EQ(f.at(100), 0.25);
    f.growth = 8;
    f.cap = 0.5;
    EXPECT_EQ(f.at(3), 3.5);
}

TEST(Transition, MorphsInTheLastPartOfEachOctave) {
    Transition t{0.5, 2, 0.25};
    for (int k = 0; k < 8; ++k) {
        double edge = std::ldexp(0.5, k);
        auto weight = [&](double target) { return t.weight(k, target / 2); }; // q W = target
        EXPECT_EQ(weight(0), 1);
        EXPECT_EQ(weight(edge), 1);
        EXPECT_EQ(weight(1.75 * edge), 1);
        EXPECT_EQ(weight(1.875 * edge), 0.5);
        EXPECT_EQ(weight(1.8125 * edge), 1 - 5.0 / 32);
        EXPECT_EQ(weight(2 * edge), 0);
        EXPECT_EQ(weight(1e9), 0);
    }
}

TEST(Transition, OneLevelAtATimeAndGoneForGood) {
    for (double part : {1e-6, 0.25, 1.0}) {
        Transition t{0.3, 1, part};
        std::mt19937 random(1);
        for (int n = 0; n < 100'000; ++n) {
            int k = static_cast<int>(random() % 5);
            // Every other one beside where the level goes.
            double w = n % 2 == 0 ? 0.3 * std::exp2(6 * uniform(random))
                                  : t.end(k) * (1 + (uniform(random) - 0.5) * 1e-14);
            if (t.weight(k, w) > 0) {
                EXPECT_FALSE(t.gone(k, w));
                EXPECT_EQ(t.weight(k + 1, w), 1);
            }
            double wider = w * (1 + 1e-15 * uniform(random));
            if (t.gone(k, w)) {
                EXPECT_TRUE(t.gone(k, wider));
                EXPECT_EQ(t.weight(k, wider), 0);
            }
        }
    }
}

// To the last bit: rule 3 compares distances of boxes with those of their points.
TEST(Distance, NoPointIsNearerThanItsBox) {
    std::mt19937 random(4);
    int equal = 0;
    for (int n = 0; n < 100'000; ++n) {
        glm::dvec3 p = random_direction(random);
        glm::dvec3 from = 2.0 * uniform(random) * random_direction(random);
        Box box;
        EXPECT_TRUE(box.empty());
        box.include(p);
        EXPECT_EQ(box.nearest(from), length(p - from));
        EXPECT_EQ(box.furthest(from), length(p - from));
        glm::dvec3 q = p;
        q[n % 3] += 0.1 * (uniform(random) - 0.5);
        box.include(q);
        for (const glm::dvec3& corner : {p, q}) {
            EXPECT_LE(box.nearest(from), length(corner - from));
            EXPECT_GE(box.furthest(from), length(corner - from));
        }
        equal += box.nearest(from) == length(p - from);
    }
    EXPECT_GT(equal, 1000);
}

TEST(Distance, FromInsideABox) {
    Box box;
    box.include({-1, -2, -3});
    box.include({1, 2, 3});
    EXPECT_EQ(box.nearest({0.5, 0.5, 0.5}), 0);
    EXPECT_EQ(box.furthest({0, 0, 0}), std::sqrt(14.0));
    EXPECT_EQ(box.nearest({1, 6, 6}), 5);
}

} // namespace
} // namespace razor::reference
