// Workers that share trees and grids, meant for ThreadSanitizer: every publication is an atomic, nothing else
// races.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace razor::test {
namespace {

TEST(SharedTree, ManyWorkersOneTree) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        Scene scene = named_scene(name)->scene;
        scene.settings.width = scene.settings.height = 96; // tiles for everybody
        const KernelTable& kernels = *native_targets().back();
        std::vector<float> first;
        for (int share : {0, 3}) {
            Frame frame(scene, {.workers = 6, .tree_of_worker = tree_groups(6, share)});
            for (int again = 0; again < 3; ++again) {
                frame.reset(); // pages stay: the first time they are made under everybody's eyes
                run_workers(frame, kernels);
                const FrameHeader& h = frame.header();
                const float* film = h.film.get();
                std::vector<float> picture(film, film + static_cast<std::ptrdiff_t>(h.width) * h.height *
                                                            film_planes);
                if (first.empty())
                    first = picture;
                ASSERT_EQ(std::memcmp(first.data(), picture.data(), first.size() * sizeof(float)), 0);
            }
        }
    }
}

/// Blocks as all camera rays see them lie among the grids: what one worker blended is there for the others,
/// and for all its samples.
TEST(SharedTree, CameraRaysShareBlendedBlocks) {
    Scene scene = named_scene("urchin_stretched")->scene;
    Settings& s = scene.settings;
    s.width = s.height = 96;
    s.lod = Lod::recursive;
    s.edge_pixels = 2;
    s.samples = 8;
    s.light_samples = s.sky_samples = 0;
    const KernelTable& kernels = *native_targets().back();
    std::vector<float> first;
    std::int64_t once = 0; // blended by one worker
    for (const auto& [workers, share] : {std::pair{1, 0}, std::pair{6, 0}, std::pair{6, 3}}) {
        Frame frame(scene, {.workers = workers, .tree_of_worker = tree_groups(workers, share)});
        run_workers(frame, kernels);
        const FrameHeader& h = frame.header();
        const float* film = h.film.get();
        std::vector<float> picture(film,
                                   film + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes);
        const FrameStatistics stats = frame.statistics();
        if (first.empty()) {
            first = picture;
            once = stats.counters.blended_blocks;
            EXPECT_GT(once, 20);
            EXPECT_GT(stats.counters.blended_tests, 4 * once);
        }
        EXPECT_EQ(std::memcmp(first.data(), picture.data(), first.size() * sizeof(float)), 0);
        // Trees that are entered in another order end in other leaves, here and there.
        EXPECT_LT(stats.counters.blended_blocks, once * stats.trees * 11 / 10);
    }
}

// Any table of workers and trees: the same picture, and statistics that count each tree's own patches and
// nodes.
TEST(SharedTree, EveryTreeIsCountedByItself) {
    Scene scene = named_scene("torus_bilinear")->scene;
    scene.settings.width = scene.settings.height = 96;
    const KernelTable& kernels = *native_targets().back();
    std::vector<float> first;
    for (const std::vector<int>& table : std::vector<std::vector<int>>{
             {}, {0, 1, 2, 0, 1, 2}, {2, 1, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 1}, {0, 1, 2, 3, 4, 5}}) {
        Frame frame(scene, {.workers = 6, .tree_of_worker = table});
        run_workers(frame, kernels);
        const FrameStatistics s = frame.statistics();
        const FrameHeader& h = frame.header();
        std::int64_t trees = 0, built = 0, opened = 0;
        for (; trees < s.trees; ++trees) {
            const TreeRecord& tree = h.trees.get()[trees];
            built += tree.root_state.word == ready ? 1 : 0;
            for (int p = 0; p < h.patch_count; ++p)
                opened += tree.patches.get()[p].state.word == ready ? 1 : 0;
        }
        EXPECT_EQ(trees, table.empty() ? 1 : *std::max_element(table.begin(), table.end()) + 1);
        for (std::size_t w = 0; w < table.size(); ++w)
            EXPECT_EQ(h.workers.get()[w].tree, table[w]);
        EXPECT_GT(s.patches, 0);
        EXPECT_LE(s.patches, trees * h.patch_count);
        EXPECT_EQ(s.counters.patches_opened, opened);
        EXPECT_EQ(s.inner_nodes + s.leaves + s.unsplit_nodes, 2 * s.inner_nodes + built);
        const float* film = h.film.get();
        std::vector<float> picture(film,
                                   film + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes);
        if (first.empty())
            first = picture;
        EXPECT_EQ(std::memcmp(first.data(), picture.data(), first.size() * sizeof(float)), 0);
    }
}

// Three workers, each of whom renders all into a tree of its own: two trees' worth is duplicate. And of
// workers that divide the picture what is left without duplicates is what one shared tree has.
TEST(SharedTree, DuplicatesAreWhatOneTreeWouldSave) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        Scene scene = named_scene(name)->scene;
        scene.settings.width = scene.settings.height = 96;
        const KernelTable& kernels = *native_targets().back();
        const auto built = [](const FrameStatistics& s) {
            return std::array{s.inner_nodes + s.leaves, s.counters.patches_opened, s.counters.blocks_made,
                              s.counters.normal_blocks};
        };
        const auto duplicates = [](const Frame& frame) {
            const Duplicates d = frame.duplicates();
            return std::array{d.nodes, d.patches, d.blocks, d.normals};
        };
        Frame one(scene, {});
        one.render(kernels, 0);
        EXPECT_EQ(duplicates(one), (std::array<std::int64_t, 4>{}));
        const auto once = built(one.statistics());
        Frame three(scene, {.workers = 3, .tree_of_worker = {0, 1, 2}});
        for (int w = 0; w < 3; ++w) {
            three.take_tiles(0, screen_tiles(scene.settings));
            three.render(kernels, w);
        }
        Frame halves(scene, {.workers = 3, .tree_of_worker = {0, 1, 2}});
        for (int w = 0; w < 2; ++w) { // the third has nothing to do
            halves.take_tiles(w == 0 ? 0 : screen_tiles(scene.settings) / 2,
                              w == 0 ? screen_tiles(scene.settings) / 2 : screen_tiles(scene.settings));
            halves.render(kernels, w);
        }
        for (std::size_t i = 0; i < once.size(); ++i) {
            EXPECT_GT(once[i], 0);
            EXPECT_EQ(duplicates(three)[i], 2 * once[i]) << name << i;
            EXPECT_GT(duplicates(halves)[i], 0);
            // Trees that are entered in another order end in other leaves, here and there.
            EXPECT_NEAR(static_cast<double>(built(halves.statistics())[i] - duplicates(halves)[i]),
                        static_cast<double>(once[i]), 0.02 * static_cast<double>(once[i]))
                << name << i;
        }
        three.reset();
        EXPECT_EQ(duplicates(three), (std::array<std::int64_t, 4>{}));
    }
}

TEST(SharedTree, TablesMustFit) {
    const Scene scene = scene_of(cube_cage(), 4);
    for (const std::vector<int>& table :
         std::vector<std::vector<int>>{{0}, {0, 0, 0}, {0, 2}, {1, 1}, {-1, 0}, {0, 1000000000}})
        EXPECT_THROW(Frame(scene, {.workers = 2, .tree_of_worker = table}), std::invalid_argument);
}

} // namespace
} // namespace razor::test
