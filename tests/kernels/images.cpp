// Pictures are the same bits, in every plane, whatever target, number of workers and sharing of trees made
// them.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

namespace razor::test {
namespace {

std::vector<float> film_of(Frame& frame) {
    const FrameHeader& h = frame.header();
    const float* film = h.film.get();
    return {film, film + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes};
}

std::vector<float> rendered(const Scene& scene, const KernelTable& kernels, int workers, int share) {
    Frame frame(scene, {.workers = workers, .tree_of_worker = tree_groups(workers, share)});
    run_workers(frame, kernels);
    return film_of(frame);
}

std::string differences(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size())
        return "sizes differ";
    std::size_t n = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::memcmp(&a[i], &b[i], sizeof(float)) != 0 && n++ == 0)
            first = i;
    return n == 0 ? "" : std::to_string(n) + " values differ, the first at " + std::to_string(first);
}

std::vector<Scene> scenes() {
    std::vector<Scene> all{small_default_scene(48, 35)};
    all.back().settings.samples = 2;
    for (const char* name : {"urchin_stretched", "torus_bilinear"})
        all.push_back(named_scene(name)->scene);
    all.push_back(scene_of(bilinear(cube_cage()), 10)); // flat patches only
    all.back().lights.push_back(all.back().lights.front());
    all.back().lights.back().corner.x += 1;
    all.push_back(all[1]); // a second light of rays at levels of their own
    all.back().settings.lod = Lod::recursive;
    all.back().lights.push_back(all.back().lights.front());
    all.back().lights.back().edge_u *= 0.1;
    all.push_back(named_scene("torus_stretched")->scene);
    all.back().settings.lod = Lod::patch;
    all.push_back(named_scene("urchin_stretched")->scene);
    all.back().settings.lod = Lod::paper;
    return all;
}

TEST(Images, AreTheSameOnEveryTarget) {
    for (const Scene& scene : scenes()) {
        std::vector<const KernelTable*> targets = targets_with(true);
        ASSERT_FALSE(targets.empty());
        std::vector<float> expected = rendered(scene, *targets.front(), 1, 0);
        int hits = 0;
        auto pixels = static_cast<std::size_t>(scene.settings.width * scene.settings.height);
        for (std::size_t i = 0; i < pixels; ++i) {
            EXPECT_TRUE(std::isfinite(expected[i]));
            hits += std::isfinite(expected[film_depth * pixels + i]) ? 1 : 0;
        }
        EXPECT_GT(hits, static_cast<int>(pixels) / 20) << scene.name;
        for (const KernelTable* target : targets)
            EXPECT_EQ(differences(rendered(scene, *target, 1, 0), expected), "")
                << scene.name << ", " << target->name;
    }
}

TEST(Images, DoNotDependOnWorkersAndSharing) {
    for (const Scene& scene : scenes())
        for (const KernelTable* target : native_targets()) {
            std::vector<float> expected = rendered(scene, *target, 1, 0);
            for (int workers : {2, 5})
                for (int share : {1, 2, 0})
                    EXPECT_EQ(differences(rendered(scene, *target, workers, share), expected), "")
                        << scene.name << ", " << target->name << ", " << workers << " workers, share "
                        << share;
        }
}

TEST(Images, DoNotDependOnTheFrameBefore) {
    for (const Scene& scene : scenes()) {
        const KernelTable& target = *native_targets().back();
        Frame frame(scene, {.workers = 2, .tree_of_worker = {0, 1}});
        run_workers(frame, target);
        std::vector<float> first = film_of(frame);
        frame.reset();
        run_workers(frame, target);
        EXPECT_EQ(differences(film_of(frame), first), "") << scene.name;
    }
}

/// sse4 rounds twice where the others fuse: the same surfaces, but shadow rays at edges may go the other way.
/// The correlation of what two pictures differ by from a third in their first plane.
double correlation(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& of,
                   std::size_t pixels) {
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double x = double{a[i]} - of[i];
        const double y = double{b[i]} - of[i];
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    return ab / std::sqrt(aa * bb);
}

TEST(Images, OfOtherSeedsHaveOtherNoise) {
    const auto seeded = [](int seed, int samples) {
        Scene scene = small_default_scene(32, 24);
        scene.settings.samples = samples;
        scene.settings.seed = seed;
        return rendered(scene, *native_targets().back(), 1, 0);
    };
    const std::vector<float> converged = seeded(3, 64);
    const std::vector<float> noisy = seeded(0, 1);
    for (const int seed : {1, 2, 0x7fffffff})
        EXPECT_LT(std::abs(correlation(noisy, seeded(seed, 1), converged, 32 * 24)), 0.1) << seed;
    EXPECT_GT(correlation(noisy, seeded(0, 1), converged, 32 * 24), 0.99);
}

TEST(Images, OfUnfusedTargetsAreNear) {
    for (const KernelTable* target : targets_with(false)) {
        Scene scene = scenes().front();
        std::vector<float> expected = rendered(scene, *targets_with(true).front(), 1, 0);
        std::vector<float> got = rendered(scene, *target, 1, 0);
        auto pixels = static_cast<std::size_t>(scene.settings.width * scene.settings.height);
        double sum = 0;
        double difference = 0;
        std::size_t moved = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            sum += expected[i];
            difference += got[i] - expected[i];
            float depth = expected[film_depth * pixels + i];
            float here = got[film_depth * pixels + i];
            if (here != depth && !(std::abs(here - depth) <= 1e-4F * depth))
                ++moved;
        }
        EXPECT_LT(moved, pixels / 100) << target->name;
        EXPECT_LT(std::abs(difference), 0.01 * sum) << target->name;
    }
}

} // namespace
} // namespace razor::test
