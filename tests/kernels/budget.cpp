// A memory budget changes no bit of a picture, whoever shares what; it is kept; what is made again is counted
// right; and the smallest that will do is what one screen tile needs.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace razor::test {
namespace {

constexpr std::uint64_t kibibyte = 1024;

Scene budget_scene(const std::string& name, Lod lod, int size = 64) {
    Scene scene = named_scene(name)->scene;
    scene.settings.width = scene.settings.height = size;
    scene.settings.lod.lod = lod;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    return scene;
}

FrameOptions bounded(int workers, int share, std::uint64_t bytes) {
    return {.workers = workers, .tree_of_worker = tree_groups(workers, share), .memory_bytes = bytes};
}

std::vector<float> picture_of(Frame& frame) {
    const FrameHeader& h = frame.header();
    const float* film = h.film.get();
    return {film, film + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes};
}

const KernelTable& best() {
    return *native_targets().back();
}

std::vector<float> unbounded_picture(const Scene& scene) {
    Frame frame(scene, {});
    frame.render(best(), 0);
    return picture_of(frame);
}

/// What the host has given memory for, of the arenas and of what says which parts are in use.
std::uint64_t resident(Frame& frame) {
    std::uint64_t bytes = 0;
    for (const isa::region& r : frame.memory().regions())
        if (r.structure == "bounded" || r.structure == "budget")
            bytes += frame.memory().resident_bytes(r);
    return bytes;
}

/// The smallest budget, to a sixteenth, that one worker can render the scene in.
std::uint64_t smallest_budget(const Scene& scene) {
    const auto does = [&](std::uint64_t bytes) {
        Frame frame(scene, bounded(1, 0, bytes));
        try {
            frame.render(best(), 0);
        } catch (const UserError&) {
            return false;
        }
        return true;
    };
    std::uint64_t least = 16 * kibibyte, most = 64 * kibibyte;
    for (; !does(most); most *= 2)
        least = most;
    while (most - least > most / 16) {
        const std::uint64_t middle = (least + most) / 2;
        (does(middle) ? most : least) = middle;
    }
    return most;
}

void expect_kept(Frame& frame, std::uint64_t bytes) {
    const BudgetStatistics s = frame.budget();
    EXPECT_EQ(s.budget_bytes, bytes);
    EXPECT_LE(s.peak_bytes, static_cast<std::int64_t>(bytes));
    // Regions end in pages of their own: the arena, the records, and a table a tree.
    EXPECT_LE(resident(frame), bytes + (4 + 2 * static_cast<std::uint64_t>(frame.workers())) * 4 * kibibyte);
    EXPECT_EQ(s.made_blocks, frame.statistics().counters.blocks_made);
    EXPECT_EQ(s.made_patches, frame.statistics().counters.patches_opened);
    EXPECT_LE(s.regenerated_blocks, s.dropped_blocks);
    EXPECT_LE(s.regenerated_nodes, s.dropped_nodes);
}

struct Case {
    std::string scene;
    Lod lod;
};
class Budget : public testing::TestWithParam<Case> {};

TEST_P(Budget, ChangesNoBit) {
    const Scene scene = budget_scene(GetParam().scene, GetParam().lod);
    const std::vector<float> expected = unbounded_picture(scene);
    const std::uint64_t least = smallest_budget(scene);
    std::int64_t most_drops = 0;
    for (const auto& [workers, share] :
         {std::pair{1, 0}, std::pair{2, 1}, std::pair{3, 0}, std::pair{4, 2}, std::pair{3, 2}}) {
        const int trees = bounded(workers, share, 1).tree_of_worker.back() + 1;
        for (const double factor : {1.1, 1.5, 3.0, 1000.0}) {
            SCOPED_TRACE(std::to_string(workers) + " workers by " + std::to_string(share) + ", factor " +
                         std::to_string(factor));
            // Of 3 workers by 2 the last one has a third for itself.
            const int parts = workers == 3 && share == 2 ? 3 : trees;
            const auto bytes = static_cast<std::uint64_t>(factor * static_cast<double>(least)) *
                               static_cast<std::uint64_t>(parts);
            Frame frame(scene, bounded(workers, share, bytes));
            run_workers(frame, best());
            EXPECT_TRUE(picture_of(frame) == expected);
            expect_kept(frame, bytes);
            const BudgetStatistics s = frame.budget();
            if (factor == 1000.0) {
                EXPECT_EQ(s.drops + s.dropped_blocks + s.dropped_nodes + s.dropped_bytes, 0);
                EXPECT_EQ(s.regenerated_blocks + s.regenerated_nodes + s.regenerated_patches, 0);
            } else if (factor == 1.1 && workers == 1) {
                EXPECT_GT(s.drops, 0);
                EXPECT_GT(s.regenerated_nodes + s.regenerated_blocks, 0);
                EXPECT_GT(s.dropped_bytes, 0);
            }
            most_drops = std::max(most_drops, s.drops);
        }
    }
    EXPECT_GT(most_drops, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Budget,
    testing::Values(Case{"urchin_stretched", Lod::recursive}, Case{"urchin_stretched", Lod::fixed},
                    Case{"urchin_stretched", Lod::camera}, Case{"torus_bilinear", Lod::recursive},
                    Case{"torus_bilinear", Lod::paper}, Case{"urchin_stretched", Lod::patch}),
    [](const auto& c) { return c.param.scene + "_" + std::to_string(static_cast<int>(c.param.lod)); });

/// One worker makes the same whether it has to make it again or not: what is more than without a budget is
/// what was regenerated.
TEST(BudgetStatistics, WhatIsMadeAgainIsCounted) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        const Scene scene = budget_scene(name, Lod::recursive);
        Frame whole(scene, {});
        whole.render(best(), 0);
        const FrameStatistics once = whole.statistics();
        const std::uint64_t least = smallest_budget(scene);
        for (const double factor : {1.0, 1.1, 1.2}) {
            Frame frame(scene,
                        bounded(1, 0, static_cast<std::uint64_t>(factor * static_cast<double>(least))));
            frame.render(best(), 0);
            const BudgetStatistics s = frame.budget();
            EXPECT_GT(s.regenerated_nodes, 0);
            EXPECT_GT(s.regenerated_blocks, 0);
            EXPECT_EQ(s.made_nodes - s.regenerated_nodes, once.inner_nodes + once.leaves);
            EXPECT_EQ(s.made_patches - s.regenerated_patches, once.counters.patches_opened);
            EXPECT_EQ(s.made_blocks - s.regenerated_blocks, once.counters.blocks_made);
            const FrameStatistics now = frame.statistics();
            EXPECT_EQ(s.made_nodes - s.dropped_nodes, now.inner_nodes + now.leaves);
            EXPECT_EQ(frame.duplicates().nodes + frame.duplicates().blocks, 0);
        }
    }
}

/// Trees that render the same tiles have the same duplicates with and without a budget, of which each tree's
/// half is little more than one worker needs, so that it drops and makes again.
TEST(BudgetStatistics, DuplicatesAreOfWhatWasEverMade) {
    const Scene scene = budget_scene("urchin_stretched", Lod::recursive);
    const std::uint64_t least = smallest_budget(scene);
    const int tiles = screen_tiles(scene.settings);
    Duplicates found[2];
    for (const bool budget : {false, true}) {
        Frame frame(scene, bounded(2, 1, budget ? 2 * (least + least / 10) : 0));
        for (int w = 0; w < 2; ++w) {
            frame.take_tiles(w == 0 ? 0 : tiles / 3, w == 0 ? tiles / 2 : tiles);
            frame.render(best(), w);
        }
        found[budget] = frame.duplicates();
        EXPECT_EQ(frame.budget().regenerated_blocks > 0, budget);
    }
    EXPECT_GT(found[0].blocks, 0);
    EXPECT_EQ(found[0].nodes, found[1].nodes);
    EXPECT_EQ(found[0].patches, found[1].patches);
    EXPECT_EQ(found[0].blocks, found[1].blocks);
    EXPECT_EQ(found[0].normals, found[1].normals);
}

/// A budget that holds the neediest tile and little more will do, and one that does not hold it will not.
TEST(BudgetSize, OneTileIsEnough) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        const Scene scene = budget_scene(name, Lod::recursive);
        std::int64_t need = 0;
        for (int tile = 0; tile < screen_tiles(scene.settings); ++tile) {
            Frame frame(scene, {});
            frame.take_tiles(tile, tile + 1);
            frame.render(best(), 0);
            const FrameStatistics s = frame.statistics();
            need = std::max(need, s.grid_bytes + s.node_bytes + s.list_bytes);
        }
        const auto least = static_cast<double>(smallest_budget(scene));
        EXPECT_GT(least, 0.9 * static_cast<double>(need)) << name;
        EXPECT_LT(least, 1.5 * static_cast<double>(need)) << name;
    }
}

TEST(BudgetSize, TooSmallIsAnError) {
    const Scene scene = budget_scene("urchin_stretched", Lod::recursive);
    const std::uint64_t least = smallest_budget(scene);
    for (const KernelTable* target : {native_targets().front(), native_targets().back()}) {
        for (const auto& [workers, share] : {std::pair{1, 0}, std::pair{3, 0}, std::pair{3, 1}}) {
            Frame frame(scene, bounded(workers, share, least / 2));
            try {
                run_workers(frame, *target);
                ADD_FAILURE() << "rendered";
            } catch (const UserError& error) {
                const std::string message = error.what();
                EXPECT_EQ(message.find('\n'), std::string::npos);
                EXPECT_NE(message.find("raise --memory"), std::string::npos) << message;
                EXPECT_EQ(message.find("--share") != std::string::npos, share == 1) << message;
            }
            // Nobody is left at the gate: the frame can be used again.
            frame.reset();
            EXPECT_THROW(run_workers(frame, *target), UserError);
        }
    }
}

/// Tiles that find no memory left are begun again, at last alone; the picture does not show it.
TEST(BudgetSize, TilesAreBegunAgain) {
    const Scene scene = budget_scene("urchin_stretched", Lod::recursive, 96);
    const std::vector<float> expected = unbounded_picture(scene);
    const std::uint64_t least = smallest_budget(scene);
    std::int64_t restarted = 0, alone = 0;
    for (int repeat = 0; repeat < 3; ++repeat) {
        Frame frame(scene, bounded(6, 0, least * 11 / 10));
        run_workers(frame, best());
        EXPECT_TRUE(picture_of(frame) == expected);
        restarted += frame.budget().restarted_tiles;
        alone += frame.budget().tiles_alone;
    }
    EXPECT_GT(restarted, 0);
    EXPECT_GT(alone, 0);
    EXPECT_LE(alone, restarted);
}

/// Frame after frame in the same memory; and the same again from one worker, to the last figure.
TEST(BudgetFrames, NothingIsLeftOver) {
    const Scene scene = budget_scene("urchin_stretched", Lod::recursive);
    const std::vector<float> expected = unbounded_picture(scene);
    const std::uint64_t bytes = smallest_budget(scene) * 3 / 2;
    Frame frame(scene, bounded(1, 0, bytes));
    BudgetStatistics first;
    for (int n = 0; n < 4; ++n) {
        frame.reset();
        EXPECT_EQ(frame.budget().made_nodes, 0);
        run_workers(frame, best());
        EXPECT_TRUE(picture_of(frame) == expected);
        expect_kept(frame, bytes);
        const BudgetStatistics s = frame.budget();
        if (n == 0)
            first = s;
        EXPECT_EQ(s.drops, first.drops);
        EXPECT_EQ(s.made_blocks, first.made_blocks);
        EXPECT_EQ(s.made_nodes, first.made_nodes);
        EXPECT_EQ(s.peak_bytes, first.peak_bytes);
        EXPECT_EQ(s.dropped_bytes, first.dropped_bytes);
    }
}

TEST(BudgetFrames, AnyBudgetAndAnySharing) {
    std::mt19937 random(11);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    constexpr Lod lods[] = {Lod::recursive, Lod::fixed, Lod::camera, Lod::discrete};
    const char* const names[] = {"urchin_stretched", "torus_bilinear"};
    for (int turn = 0; turn < 12; ++turn) {
        const std::string name = names[below(2)];
        Scene scene = budget_scene(name, lods[below(4)], 48 + 16 * below(3));
        scene.settings.edge_pixels = 1 + below(3);
        const std::vector<float> expected = unbounded_picture(scene);
        const std::uint64_t least = smallest_budget(scene);
        for (int n = 0; n < 4; ++n) {
            const int workers = 1 + below(5), share = below(workers + 1);
            const double factor = 1.1 + below(100) / 25.0;
            // The smallest share is that of one worker alone.
            const int parts = share == 0 ? 1 : (workers % share == 0 ? workers / share : workers);
            const auto bytes = static_cast<std::uint64_t>(factor * static_cast<double>(least)) *
                               static_cast<std::uint64_t>(parts);
            SCOPED_TRACE(name + ": turn " + std::to_string(turn) + ", " + std::to_string(workers) +
                         " workers by " + std::to_string(share) + ", " + std::to_string(bytes) + " bytes");
            Frame frame(scene, bounded(workers, share, bytes));
            run_workers(frame, best());
            EXPECT_TRUE(picture_of(frame) == expected);
            expect_kept(frame, bytes);
        }
    }
}

} // namespace
} // namespace razor::test
