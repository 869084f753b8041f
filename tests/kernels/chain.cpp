// Leaves of many levels in one cell (razor/kernels/chain.h): rays that go beyond all of them at once find
// what rays do that go from one to the next, whoever went before them, and visit fewer nodes.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace razor::test {
namespace {

/// Faces of many levels.
Scene near_cube() {
    Scene scene = named_scene("cube")->scene;
    scene.settings.lod = Lod::recursive;
    scene.meshes[0].edge_length /= 16;
    return scene;
}

std::vector<Ray> rays_asking(Frame& frame, RayMaker& make, int count, int level) {
    const double edge = frame.header().instances.get()[0].edge_length;
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Ray r = make.random_ray();
        if (i % 2 == 0)
            r.direction = make.direction_at_feature(r.origin);
        r.base = static_cast<float>(std::ldexp(edge, level));
        rays.push_back(r);
    }
    return rays;
}

class Chain : public testing::TestWithParam<std::string> {};

// Finest first, so that the first lists of chains know the last ones, then all others in any order, each also
// by a frame that nobody else has been in.
TEST_P(Chain, LeadsNobodyPastWhatTheyAskFor) {
    constexpr int count = 512;
    Scene scene = named_scene(GetParam())->scene;
    scene.settings.lod = Lod::recursive;
    scene.meshes[0].edge_length /= 4;
    const KernelTable& target = *native_targets().back();
    Frame built(scene, {});
    built.build_all(target);
    const Oracle oracle(built, true);
    RayMaker make(oracle.triangles(), oracle.origins(), 5);
    Frame shared(scene, {});
    Tracer tracer(shared, count);
    std::size_t hits = 0;
    for (const int level : {0, 3, 1, 4, 2, 0, 4, 3}) {
        const std::vector<Ray> rays = rays_asking(shared, make, count, level);
        Frame alone(scene, {});
        Tracer first(alone, count);
        const std::vector<Hit> expected = first.closest(target, rays), got = tracer.closest(target, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(got[i] == expected[i]) << "level " << level << ", ray " << i;
            hits += got[i].patch >= 0 ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 400U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Chain, testing::Values("cube", "torus_stretched", "torus_bilinear"),
                         [](const auto& name) { return name.param; });

// With a budget, lists may be dropped: there everyone goes from level to level.
TEST(ChainOfCube, SparesVisitsAndNoBit) {
    Scene scene = near_cube();
    scene.settings.width = scene.settings.height = 64;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    const KernelTable& target = *native_targets().back();
    Frame free(scene, {.workers = 1}),
        bounded(scene, {.workers = 1, .memory_bytes = std::uint64_t{1} << 30U});
    free.render(target, 0);
    bounded.render(target, 0);
    const FrameHeader &a = free.header(), &b = bounded.header();
    const std::size_t floats = static_cast<std::size_t>(a.width) * 64 * film_planes;
    EXPECT_TRUE(std::equal(a.film.get(), a.film.get() + floats, b.film.get()));
    const Counters c = free.statistics().counters, d = bounded.statistics().counters;
    EXPECT_EQ(c.box_tests, d.box_tests);
    EXPECT_EQ(c.quad_tests, d.quad_tests);
    EXPECT_EQ(c.blocks_made, d.blocks_made);
    EXPECT_LT(static_cast<double>(c.node_visits), 0.8 * static_cast<double>(d.node_visits));
}

} // namespace
} // namespace razor::test
