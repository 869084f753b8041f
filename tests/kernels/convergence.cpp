// Hits come nearer to the limit surface as the square of the edges that rays ask for: flat triangles on a
// smooth surface.
#include "razor/check/convergence.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

namespace razor::test {
namespace {

class Convergence : public testing::TestWithParam<std::string> {};

TEST_P(Convergence, IsOfSecondOrder) {
    const std::optional<NamedScene> named = named_scene(GetParam());
    const check::ConvergenceReport report =
        check::measure_convergence(named->scene, *native_targets().back(), {});
    ASSERT_EQ(report.steps.size(), 5U);
    EXPECT_GT(report.steps.front().hits, 500);
    EXPECT_GT(report.order, 1.6);
    EXPECT_LT(report.order, 2.4);
    // The report's own law: halving edges by four octaves divides the error by about 2^(4 order).
    EXPECT_NEAR(report.steps.front().edge, 16 * report.steps.back().edge, 1e-6 * report.steps.front().edge);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Convergence, testing::Values("cube", "torus_stretched", "urchin"),
                         [](const auto& name) { return name.param; });

TEST(ConvergenceOfFlatMeshes, IsNotMeasured) {
    Scene scene = scene_of(bilinear(cube_cage()), 20);
    EXPECT_FALSE(check::measure_convergence(scene, *native_targets().back(), {}).converges());
}

} // namespace
} // namespace razor::test
