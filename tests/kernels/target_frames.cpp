// Frames of a stated relative error: what is said of it against converged pictures, and of levels of detail
// against pictures of other edges.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/native/edge_choice.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace razor::test {
namespace {

Scene noisy_scene(int width, int height) {
    Scene scene = small_default_scene(width, height);
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    scene.settings.samples = 16;
    return scene;
}

RenderResult render(const Scene& scene, RenderOptions options = {}) {
    if (options.threads == 0)
        options.threads = 1;
    return render_native(scene, options);
}

/// As pbrt's imgtool and `razor compare` define it, by its root.
double relative_error(const Film& film, const Film& reference) {
    double sum = 0;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            const double r = double{reference.find(name)->values[i]};
            sum += std::pow((double{film.find(name)->values[i]} - r) / (r + 0.01), 2);
        }
    return std::sqrt(sum / (3 * static_cast<double>(film.pixel_count())));
}

bool same_bits(const Film& a, const Film& b) {
    return a.planes.size() == b.planes.size() &&
           std::equal(a.planes.begin(), a.planes.end(), b.planes.begin(), [](const Plane& x, const Plane& y) {
               return std::memcmp(x.values.data(), y.values.data(), x.values.size() * sizeof(float)) == 0;
           });
}

TEST(TargetFrames, AreAsGoodAsTheySay) {
    Scene scene = noisy_scene(64, 48);
    scene.settings.lod = Lod::fixed; // one surface, whatever rays ask for
    Scene converged = scene;
    converged.settings.seed = 77;
    converged.settings.samples = 2048;
    const Film reference = render(converged).film;
    for (const FilterKind filter : {FilterKind::box, FilterKind::mitchell}) {
        scene.settings.filter = converged.settings.filter = preset_filter(filter);
        const Film truth = filter == FilterKind::box ? reference : render(converged).film;
        double before = 0;
        for (const double target : {0.03, 0.015}) {
            const RenderResult result = render(scene, {.passes = {.target_error = target}});
            const PassFigures& figures = result.statistics.times.back().passes;
            const double error = relative_error(result.film, truth);
            EXPECT_LE(figures.target_error, target);
            EXPECT_GT(figures.target_error, 0.6 * target);
            EXPECT_GT(figures.target_error / error, 0.9) << target; // samples fill each other's gaps
            EXPECT_LT(figures.target_error / error, 1.6) << target;
            EXPECT_LT(figures.target_error_uncertainty, 0.1 * figures.target_error);
            EXPECT_GT(figures.mean_samples, before);
            before = figures.mean_samples;
            RecordProperty("told_over_true", std::to_string(figures.target_error / error));
        }
    }
}

TEST(TargetFrames, DoNotDependOnWhoRenders) {
    const Scene scene = noisy_scene(40, 32);
    const PassOptions passes{.target_error = 0.04};
    const Film expected = render(scene, {.passes = passes}).film;
    const std::vector<float>& samples = expected.find("samples")->values;
    EXPECT_LT(*std::min_element(samples.begin(), samples.end()),
              *std::max_element(samples.begin(), samples.end()));
    EXPECT_TRUE(same_bits(render(scene, {.threads = 3, .share = 2, .passes = passes}).film, expected));
    for (const KernelTable* kernels : targets_with(true))
        EXPECT_TRUE(same_bits(render(scene, {.passes = passes, .kernels = kernels}).film, expected))
            << kernels->name;
}

TEST(TargetFrames, EndInTime) {
    const RenderResult result =
        render(noisy_scene(48, 32), {.passes = {.seconds = 0.3, .target_error = 1e-4}});
    const PassFigures& figures = result.statistics.times.back().passes;
    EXPECT_GE(figures.passes, 1);
    EXPECT_LT(figures.samples, most_target_samples);
    EXPECT_TRUE(figures.passes == 1 || figures.target_error > 1e-4);
}

TEST(TargetFrames, NeedAChoice) {
    const PassOptions passes{.target_error = 0.1};
    RenderOptions layers{.passes = passes};
    layers.layers.add(LayerGroup::pick);
    EXPECT_THROW(render(noisy_scene(16, 16), layers), UserError);
    EXPECT_THROW(render(noisy_scene(16, 16), {.frames = 2, .passes = passes}), UserError);
    Scene both = noisy_scene(16, 16);
    both.settings.noise_threshold = 0.1;
    both.settings.samples = 64;
    EXPECT_THROW(render(both, {.passes = passes}), UserError);
}

/// The difference of pictures with so little noise that it does not matter.
double true_difference(Scene scene, double edge_pixels) {
    scene.settings.samples = 1024;
    scene.settings.edge_pixels = edge_pixels;
    const Film coarse = render(scene).film;
    scene.settings.edge_pixels = 0.5 * edge_pixels;
    return relative_error(coarse, render(scene).film);
}

TEST(EdgeChoice, KnowsHowFarLevelsDiffer) {
    Scene scene = noisy_scene(40, 32);
    for (const double edge : {8.0, 1.0}) { // one of them lost in noise, which must not count
        scene.settings.edge_pixels = edge;
        const LevelDifference found = level_difference(scene, {.threads = 1}, 0.5);
        const double expected = true_difference(scene, edge);
        EXPECT_EQ(found.pixels, 40U * 32U) << "all tiles of a small picture";
        EXPECT_NEAR(found.square, expected * expected, 4 * found.square_uncertainty) << edge;
        if (edge == 8) {
            EXPECT_GT(found.error, 0.1) << "nothing was compared";
            EXPECT_LT(found.square_uncertainty, 0.4 * found.square);
        }
    }
}

TEST(EdgeChoice, IsFinerWhereLevelsDifferTooMuch) {
    Scene scene = noisy_scene(40, 32);
    scene.settings.edge_pixels = 8;
    const EdgeChoice choice = choose_edge(scene, {.threads = 1}, 0.06, false);
    EXPECT_LT(choice.chosen.edge_pixels, 8);
    EXPECT_GE(choice.chosen.edge_pixels, 1);
    EXPECT_FALSE(choice.given);
    const EdgeChoice loose = choose_edge(scene, {.threads = 1}, 5, false);
    EXPECT_EQ(loose.chosen.edge_pixels, 32) << "the coarsest that is tried";
    const EdgeChoice given = choose_edge(scene, {.threads = 1}, 0.06, true);
    EXPECT_EQ(given.chosen.edge_pixels, 8);
    EXPECT_GT(given.chosen.error, 0.03);
    scene.meshes[0].edge_length = 0.1;
    const EdgeChoice stated = choose_edge(scene, {.threads = 1}, 0.06, false);
    EXPECT_EQ(stated.chosen.edge_pixels, 8);
    EXPECT_TRUE(stated.given);
}

TEST(EdgeChoice, SaysWhereNothingHasLevels) {
    Scene scene = noisy_scene(24, 24);
    std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.name != "floor"; });
    ASSERT_EQ(scene.meshes.size(), 1U);
    const EdgeChoice choice = choose_edge(scene, {.threads = 1}, 0.05, false);
    EXPECT_EQ(choice.chosen.square, 0);
    EXPECT_EQ(choice.chosen.square_uncertainty, 0);
    EXPECT_EQ(choice.chosen.edge_pixels, scene.settings.edge_pixels);
}

} // namespace
} // namespace razor::test
