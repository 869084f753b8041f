// What no ray asks for is not built, and the statistics say so.
#include "razor/check/dump.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/rays.h"
#include "tests/kernels/targets.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>

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
    float left = frame.header().instances.get()[0].origin[0];
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

/// Blocks known to the tree, and those of them that have no vertices.
std::array<int, 2> blocks_without_vertices(Frame& frame) {
    std::array<int, 2> blocks{};
    const OpenPatch* patches = frame.header().trees.get()[0].patches.get();
    for (int p = 0; p < frame.header().patch_count; ++p) {
        if (patches[p].state.word != ready)
            continue;
        for (int level = check::block_at(frame, patches[p].root).header->level; level >= 0; --level) {
            const auto known = check::known_blocks_of(frame, p, 0, level).size();
            const auto made = check::blocks_of(frame, p, 0, level).size();
            blocks[0] += static_cast<int>(known);
            blocks[1] += static_cast<int>(known - made);
        }
    }
    return blocks;
}

/// Neighbours of what is seen are known by their boxes, and rays that pass these by make no vertices.
TEST(Laziness, BlocksThatNoRayMeetsHaveNoVertices) {
    Frame frame(scene_of(torus_cage(8, 6), 600), {});
    Tracer tracer(frame, 64);
    std::vector<Ray> rays;
    for (int i = 0; i < 64; ++i) {
        const float x = 0.9F + 0.01F * static_cast<float>(i % 8);
        rays.push_back({{x, 5, 0.01F * static_cast<float>(i / 8)}, {0, -1, 0}});
    }
    const KernelTable& kernels = *native_targets().back();
    const std::vector<Hit> lazy = tracer.closest(kernels, rays);
    EXPECT_GE(lazy.front().patch, 0);
    const std::array<int, 2> after_rays = blocks_without_vertices(frame);
    const Counters counted = frame.statistics().counters;
    EXPECT_GT(after_rays[1], after_rays[0] / 4);
    EXPECT_EQ(counted.blocks_made, after_rays[0] - after_rays[1]);

    frame.build_all(kernels);
    const std::array<int, 2> eager = blocks_without_vertices(frame);
    EXPECT_GT(eager[0], 4 * after_rays[0]);
    EXPECT_EQ(eager[1], 0);
    EXPECT_EQ(frame.statistics().counters.blocks_made, eager[0]);
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
    EXPECT_EQ(frame.statistics().by_kind.kind[kind_camera].rays, 32 * 32);
}

/// A square of n x n tori 4 apart, all one mesh.
Scene square_of_tori(int n) {
    Scene scene = scene_of(torus_cage(16, 12), 60); // three clusters of patches each
    Placement torus{.name = "torus", .mesh = 0, .local = {}};
    torus.copies = {n, 1, n};
    torus.spacing = {4, 0, 4};
    scene.graph.groups = {{"scene", {torus}}};
    return scene;
}

/// Rays down on the torus at one corner of the square, and a little beside it: in steps that a float holds
/// wherever the corner is, and off the torus's planes of symmetry, so that none meets just an edge.
std::vector<Ray> rays_at_a_corner(Frame& frame) {
    const float* corner = frame.header().instances.get()[0].origin;
    std::vector<Ray> rays;
    for (int i = 0; i < 1024; ++i) {
        const float x = corner[0] - 1.5F + static_cast<float>(6 * (i % 32) + 1) / 64;
        const float z = corner[2] - 1.5F + static_cast<float>(6 * (i / 32) + 1) / 64;
        rays.push_back({{x, 5, z}, {0, -1, 0}});
    }
    return rays;
}

struct Looked {
    FrameStatistics statistics;
    std::vector<Hit> hits;
};
Looked look_at_a_corner(int n) {
    Frame frame(square_of_tori(n), {});
    Tracer tracer(frame, 1024);
    Looked l;
    l.hits = tracer.closest(*native_targets().back(), rays_at_a_corner(frame));
    l.statistics = frame.statistics();
    return l;
}

TEST(Laziness, InstancesThatNoRayMeetsStayClosed) {
    const FrameStatistics s = look_at_a_corner(50).statistics;
    EXPECT_EQ(s.instances, 2500);
    EXPECT_EQ(s.patches, 2500 * 192);
    EXPECT_EQ(s.clusters, 2500 * 3);
    EXPECT_GE(s.instances_opened, 1);
    EXPECT_LE(s.instances_opened, 4);
    EXPECT_GE(s.clusters_opened, 3);
    EXPECT_LE(s.clusters_opened, 12);
    EXPECT_GT(s.counters.patches_opened, 0);
    EXPECT_LE(s.counters.patches_opened, 2 * 192);
    EXPECT_GT(s.graph_nodes, 2500);
    EXPECT_LE(s.graph_nodes_opened, 30);
}

TEST(Laziness, UnseenInstancesTakeNoMemory) {
    const Looked few = look_at_a_corner(10);
    const Looked many = look_at_a_corner(100);
    EXPECT_EQ(many.statistics.instances, 100 * few.statistics.instances);
    // The same patches, an entry in the tables of patches for each, and a few more levels of a tree; as
    // planes are tried at places in a larger box, cells differ, and with them whether a block beside a ray is
    // made finer.
    EXPECT_EQ(many.statistics.counters.patches_opened, few.statistics.counters.patches_opened);
    EXPECT_NEAR(static_cast<double>(many.statistics.counters.blocks_made),
                static_cast<double>(few.statistics.counters.blocks_made),
                static_cast<double>(few.statistics.counters.blocks_made) * 0.01);
    EXPECT_NEAR(static_cast<double>(many.statistics.grid_bytes),
                static_cast<double>(few.statistics.grid_bytes),
                static_cast<double>(few.statistics.grid_bytes) * 0.01);
    EXPECT_EQ(many.statistics.patch_table_bytes, few.statistics.patch_table_bytes);
    EXPECT_LE(many.statistics.list_bytes, few.statistics.list_bytes * 5 / 4);
    EXPECT_LE(many.statistics.node_bytes, few.statistics.node_bytes * 5 / 4);
    EXPECT_EQ(many.statistics.topology_bytes, few.statistics.topology_bytes);
    EXPECT_EQ(many.statistics.control_point_bytes, few.statistics.control_point_bytes);
    const std::int64_t more = many.statistics.scene_graph_bytes - few.statistics.scene_graph_bytes;
    EXPECT_LE(more, 9900 * 320) << "records of instances and graph nodes";
    const auto is_hit = [](const Hit& h) { return h.patch >= 0; };
    EXPECT_GT(std::count_if(few.hits.begin(), few.hits.end(), is_hit), 512);
    EXPECT_EQ(few.hits, many.hits);
}

TEST(Laziness, ResetClosesEverything) {
    Frame frame(square_of_tori(20), {});
    Tracer tracer(frame, 1024);
    const KernelTable& kernels = *native_targets().back();
    const std::vector<Ray> rays = rays_at_a_corner(frame);
    const std::vector<Hit> lazy = tracer.closest(kernels, rays);
    const FrameStatistics before = frame.statistics();
    frame.build_all(kernels);
    const FrameStatistics eager = frame.statistics();
    EXPECT_EQ(eager.instances_opened, 400);
    EXPECT_EQ(eager.clusters_opened, 1200);
    EXPECT_EQ(eager.graph_nodes_opened, eager.graph_nodes);
    EXPECT_EQ(eager.counters.patches_opened, eager.patches);
    EXPECT_EQ(tracer.closest(kernels, rays), lazy);
    frame.reset();
    const FrameStatistics empty = frame.statistics();
    EXPECT_EQ(empty.graph_nodes_opened + empty.instances_opened + empty.clusters_opened, 0);
    EXPECT_EQ(empty.patch_table_bytes, 0);
    EXPECT_EQ(tracer.closest(kernels, rays), lazy);
    const FrameStatistics again = frame.statistics();
    EXPECT_EQ(again.instances_opened, before.instances_opened);
    EXPECT_EQ(again.counters.patches_opened, before.counters.patches_opened);
}

/// Blocks are listed where rays can see their vertices and not much further: bounds that added up how far the
/// corners of all coarser blocks can move had rays meet eight times as many blocks here as at a fixed level.
TEST(Laziness, RaysMeetNoMoreBlocksBlendedThanNot) {
    const auto tests = [](Lod lod) {
        Scene scene = scene_of(bevelled_slab(), 300);
        scene.settings.width = scene.settings.height = 64;
        scene.settings.lod = lod;
        Frame frame(scene, {});
        frame.render(*native_targets().back(), 0);
        return frame.statistics().counters;
    };
    const Counters fixed = tests(Lod::fixed), recursive = tests(Lod::recursive);
    EXPECT_GT(fixed.block_tests, 1000);
    EXPECT_GT(recursive.blended_tests, recursive.block_tests / 10);
    EXPECT_LT(recursive.block_tests, fixed.block_tests * 3 / 2);
    EXPECT_LT(recursive.box_tests, fixed.box_tests * 3 / 2);
}

TEST(Laziness, FirstPacketAndTilesAreTimed) {
    Frame frame(square_of_tori(3), {});
    EXPECT_EQ(frame.statistics().first_packet_seconds, 0);
    frame.render(*native_targets().back(), 0);
    const FrameStatistics s = frame.statistics();
    EXPECT_GT(s.refit_seconds, 0);
    EXPECT_GT(s.first_packet_seconds, s.refit_seconds);
    EXPECT_LT(s.first_packet_seconds, 60);
    EXPECT_EQ(s.tiles, frame.header().tiles_end);
    EXPECT_GE(s.slowest_tile_seconds * static_cast<double>(s.tiles), s.tile_seconds);
    EXPECT_LE(s.slowest_tile_seconds, s.tile_seconds);
    EXPECT_GT(s.tile_seconds, s.first_packet_seconds - s.refit_seconds) << "which lies in the first tile";
    EXPECT_GE(s.slowest_tile, 0);
    EXPECT_LT(s.slowest_tile, s.tiles);
    frame.reset();
    EXPECT_EQ(frame.statistics().tiles, 0);
    EXPECT_EQ(frame.statistics().first_packet_seconds, 0);
}

} // namespace
} // namespace razor::test
