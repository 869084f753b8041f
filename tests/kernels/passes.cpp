// Samples taken in passes are those of one go, whatever each pass takes, whoever renders it and however
// little memory there is; and what is said of their error is near the truth.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

namespace razor::test {
namespace {

Scene scene_with(Lod lod, FilterKind filter, int samples) {
    Scene scene = named_scene("urchin_stretched")->scene;
    scene.settings.lod = lod;
    scene.settings.filter = preset_filter(filter);
    scene.settings.samples = samples;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    return scene;
}

Film in_passes(const Scene& scene, const std::vector<int>& passes, const KernelTable& kernels,
               FrameOptions options = {}) {
    options.passes = true;
    Frame frame(scene, options);
    int taken = 0;
    for (const int count : passes) {
        frame.take_samples(taken, count);
        run_workers(frame, kernels);
        taken += count;
    }
    return frame.film();
}

Film in_one_go(const Scene& scene, const KernelTable& kernels) {
    Frame frame(scene, {});
    run_workers(frame, kernels);
    return frame.film();
}

bool same_bits(const Film& a, const Film& b) {
    return std::equal(a.planes.begin(), a.planes.end(), b.planes.begin(), b.planes.end(),
                      [](const Plane& x, const Plane& y) {
                          return std::memcmp(x.values.data(), y.values.data(),
                                             x.values.size() * sizeof(float)) == 0;
                      });
}

/// Largest difference of a plane's values, over the larger one and 0.01.
double apart(const Film& a, const Film& b) {
    double most = 0;
    for (const Plane& plane : a.planes)
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            const double x = plane.values[i], y = b.find(plane.name)->values[i];
            if (x != y) // also infinite depths
                most = std::max(most, std::abs(x - y) / std::max({std::abs(x), std::abs(y), 0.01}));
        }
    return most;
}

TEST(Passes, SumUpToOneGo) {
    for (const auto& [filter, lod] :
         {std::pair{FilterKind::box, Lod::fixed}, std::pair{FilterKind::mitchell, Lod::camera}}) {
        const Scene scene = scene_with(lod, filter, 8);
        const Film expected = in_one_go(scene, *native_targets().back());
        Film first;
        for (const KernelTable* kernels : targets_with(true)) {
            const Film film = in_passes(scene, {1, 3, 4}, *kernels);
            EXPECT_LT(apart(film, expected), 2e-5) << kernels->name;
            if (first.planes.empty())
                first = film;
            EXPECT_TRUE(same_bits(film, first)) << kernels->name;
        }
        EXPECT_TRUE(same_bits(in_passes(scene, {8}, *native_targets().back()), expected));
    }
}

/// Rays that leave surfaces come in another order, and find other rays to share levels of detail with.
TEST(Passes, AreNearOneGoWhereRaysShareFields) {
    const Scene scene = scene_with(Lod::recursive, FilterKind::box, 16);
    const Film passes = in_passes(scene, {4, 4, 4, 4}, *native_targets().back());
    const Film go = in_one_go(scene, *native_targets().back());
    for (const char* name : {"albedo.G", "depth.Z"}) // what camera rays see has the same levels
        for (std::size_t i = 0; i < go.pixel_count(); ++i) {
            const float x = passes.find(name)->values[i], y = go.find(name)->values[i];
            ASSERT_TRUE(x == y || std::abs(x - y) < 1e-5F * std::abs(y)) << name;
        }
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < go.pixel_count(); ++i) {
        sum += double{go.find("G")->values[i]};
        difference += std::abs(double{go.find("G")->values[i]} - double{passes.find("G")->values[i]});
    }
    EXPECT_LT(difference / sum, 0.01);
}

TEST(Passes, DoNotDependOnWorkersOrMemory) {
    const KernelTable& kernels = *native_targets().back();
    const std::vector<int> passes{2, 2, 4};
    for (const FilterKind filter : {FilterKind::box, FilterKind::mitchell}) {
        const Scene scene = scene_with(Lod::recursive, filter, 8);
        const Film expected = in_passes(scene, passes, kernels);
        EXPECT_TRUE(
            same_bits(in_passes(scene, passes, kernels, {.workers = 3, .tree_of_worker = tree_groups(3, 2)}),
                      expected));
        // Tiles are begun again in little memory, after some of their pixels were added to what is kept.
        bool rendered = false;
        for (std::uint64_t bytes = 64 << 10; !rendered; bytes = bytes * 5 / 4) {
            try {
                EXPECT_TRUE(same_bits(in_passes(scene, passes, kernels, {.memory_bytes = bytes}), expected));
                rendered = true;
            } catch (const UserError&) {
                // too little
            }
        }
    }
}

TEST(Passes, FollowEachOther) {
    const Scene scene = scene_with(Lod::fixed, FilterKind::box, 4);
    const KernelTable& kernels = *native_targets().back();
    EXPECT_THROW(Frame(scene, {}).take_samples(0, 1), std::invalid_argument);
    Frame frame(scene, {.passes = true});
    frame.take_samples(0, 1);
    run_workers(frame, kernels);
    EXPECT_THROW(frame.take_samples(2, 1), std::invalid_argument);
    frame.reset(); // one go again
    run_workers(frame, kernels);
    EXPECT_TRUE(same_bits(frame.film(), in_one_go(scene, kernels)));
}

TEST(ErrorEstimate, IsThatOfAMeanOfNoise) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 1);
    ErrorEstimate estimate;
    Film film = make_film(100, 100);
    std::vector<double> sums(film.pixel_count());
    int samples = 0;
    for (const int batch : {4, 4, 8, 2, 4, 4, 6}) {
        samples += batch;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i] += 2 * batch + noise(random) * std::sqrt(batch);
            for (const char* name : {"R", "G", "B"})
                film.find(name)->values[i] = static_cast<float>(sums[i] / samples);
        }
        estimate.add(film, samples);
        if (samples == batch) {
            EXPECT_EQ(estimate.error(), 0);
        }
    }
    EXPECT_NEAR(estimate.error(), 1 / std::sqrt(32.0), 0.005);
    EXPECT_NEAR(estimate.relative_error(), 0.5 / std::sqrt(32.0), 0.0025);
}

RenderResult render(const Scene& scene, PassOptions passes) {
    RenderOptions options;
    options.threads = 1;
    options.passes = std::move(passes);
    return render_native(scene, options);
}

double luminance(const Film& film, std::size_t i) {
    return 0.2126 * double{film.find("R")->values[i]} + 0.7152 * double{film.find("G")->values[i]} +
           0.0722 * double{film.find("B")->values[i]};
}

TEST(Passes, TellHowFarTheyAreOff) {
    Scene scene = small_default_scene(28, 20);
    scene.settings.lod = Lod::fixed;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    scene.settings.samples = 16;
    std::vector<int> told;
    PassFigures last;
    const RenderResult result =
        render(scene, {.samples = 4, .passed = [&](const Film& film, const PassFigures& f) {
                           EXPECT_EQ(film.width, 28);
                           told.push_back(f.samples);
                           last = f;
                       }});
    EXPECT_EQ(told, (std::vector<int>{4, 8, 12, 16}));
    const PassFigures& figures = result.statistics.times.back().passes;
    EXPECT_EQ(figures.samples, 16);
    EXPECT_EQ(figures.passes, 4);
    EXPECT_EQ(figures.error, last.error);
    scene.settings.samples = 256;
    const Film converged = render(scene, {}).film;
    double squares = 0;
    for (std::size_t i = 0; i < converged.pixel_count(); ++i)
        squares += std::pow(luminance(result.film, i) - luminance(converged, i), 2);
    const double error = std::sqrt(squares / static_cast<double>(converged.pixel_count()));
    EXPECT_GT(figures.error / error, 0.8);
    EXPECT_LT(figures.error / error, 2.5);
    RecordProperty("told_over_true", std::to_string(figures.error / error));
}

TEST(Passes, GoOnForATime) {
    Scene scene = small_default_scene(16, 16);
    scene.settings.samples = 4;
    const PassFigures one =
        render(scene, {.samples = 4, .seconds = 1e-6, .passed = {}}).statistics.times.back().passes;
    EXPECT_EQ(one.samples, 4);
    EXPECT_EQ(one.passes, 1);
    const PassFigures more = render(scene, {.samples = 4, .seconds = 15 * one.seconds, .passed = {}})
                                 .statistics.times.back()
                                 .passes;
    EXPECT_GT(more.passes, 2);
    EXPECT_EQ(more.samples, 4 * more.passes);
}

} // namespace
} // namespace razor::test
