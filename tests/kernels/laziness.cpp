// What no ray asks for is not built, and the statistics say so.
#include "tests/kernels/cages.h"
#include "tests/kernels/rays.h"
#include "tests/kernels/targets.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace razor::test {
namespace {

/// Sixteen tori in a row along x, of which rays meet the first alone.
Scene row_of_tori() {
    Mesh torus = torus_cage(8, 6);
    Scene scene = scene_of(torus, 60);
    for (int i = 1; i < 16; ++i) {
        Mesh copy = scene.meshes.front();
        for (glm::dvec3& p : copy.points)
            p.x += 4 * i;
        scene.meshes.push_back(copy);
    }
    return scene;
}

TEST(Laziness, WhatNoRayMeetsStaysUnbuilt) {
    Frame frame(row_of_tori(), {});
    Tracer tracer(frame, 1024);
    float left = frame.header().meshes.get()[0].origin[0];
    std::vector<Ray> rays;
    for (int i = 0; i < 1024; ++i) {
        float x = left - 1.0F + static_cast<float>(i % 32) / 16;
        float z = -1.0F + static_cast<float>(i / 32) / 16;
        rays.push_back({{x, 5, z}, {0, -1, 0}});
    }
    const KernelTable& kernels = *native_targets().back();
    std::vector<Hit> lazy = tracer.closest(kernels, rays);
    FrameStatistics after_rays = frame.statistics();
    int tori = 16;
    EXPECT_EQ(after_rays.patches, 48 * tori);
    EXPECT_GT(after_rays.counters.patches_opened, 0);
    EXPECT_LE(after_rays.counters.patches_opened, 2 * 48);
    EXPECT_GT(after_rays.unsplit_nodes, 0);
    EXPECT_GT(after_rays.leaves, 0);

    frame.build_all(kernels);
    FrameStatistics eager = frame.statistics();
    EXPECT_EQ(eager.counters.patches_opened, 48 * tori);
    EXPECT_EQ(eager.unsplit_nodes, 0);
    EXPECT_GT(eager.grid_bytes, 4 * after_rays.grid_bytes);
    EXPECT_GT(eager.inner_nodes, after_rays.inner_nodes);
    EXPECT_EQ(tracer.closest(kernels, rays), lazy);

    // And nothing at all without a ray.
    frame.reset();
    FrameStatistics empty = frame.statistics();
    EXPECT_EQ(empty.counters.patches_opened, 0);
    EXPECT_EQ(empty.inner_nodes + empty.leaves + empty.unsplit_nodes, 0);
    EXPECT_EQ(tracer.closest(kernels, rays), lazy);
}

TEST(Laziness, ShadingNormalsAreMadeWhereCamerasLook) {
    Scene scene = row_of_tori();
    Frame frame(scene, {});
    const KernelTable& kernels = *native_targets().back();
    frame.render(kernels, 0);
    Counters c = frame.statistics().counters;
    EXPECT_GT(c.normal_blocks, 0);
    EXPECT_LT(c.normal_blocks, c.blocks_made);
    EXPECT_EQ(c.camera_rays, 32 * 32);
}

} // namespace
} // namespace razor::test
