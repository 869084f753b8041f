// What a ray hits moves continuously with its footprint, unless the number of crossings changes.
#include "tests/reference/continuity.h"

#include <gtest/gtest.h>

namespace razor::reference {
namespace {

Jumps jumps_of(const std::string& scene, const std::string& scheme, double growth) {
    Setting s;
    s.scene = scene;
    s.random_exponents = true;
    s.growth = growth;
    s.e0 = 0.13;
    s.origins = 1;
    s.rays = 30;
    return jumps(s, scheme, 6, 12);
}

TEST(Continuity, HitsDoNotPop) {
    long folds = 0;
    for (const char* scene : {"torus", "relief"})
        for (double growth : {-0.1, 0.2}) {
            Jumps j = jumps_of(scene, "walk", growth);
            EXPECT_GT(j.steps, 4000);
            EXPECT_EQ(j.pops, 0) << scene << ' ' << growth;
            folds += j.folds;
        }
    EXPECT_GT(folds, 0); // there was something to tell apart
}

TEST(Continuity, WholeLevelsPop) {
    EXPECT_GT(jumps_of("torus", "discrete", 0.2).pops, 0);
    EXPECT_GT(jumps_of("torus", "patch", 0.2).pops, 0);
}

} // namespace
} // namespace razor::reference
