// Frames whose screen tiles take different numbers of samples: each tile is, to the last bit, what it is
// where all take as many; and what is said of noise is true of pictures.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/adaptive_sampling.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace razor::test {
namespace {

const KernelTable& best() {
    return *native_targets().back();
}

Scene urchin(FilterKind filter, Lod lod) {
    Scene scene = named_scene("urchin_stretched")->scene;
    scene.settings.lod = lod;
    scene.settings.filter = preset_filter(filter);
    scene.settings.samples = 32;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    return scene;
}

/// Of all tiles, so many samples pass by pass.
Film in_passes(const Scene& scene, const std::vector<int>& ends, const KernelTable& kernels) {
    Frame frame(scene, {.passes = true});
    int taken = 0;
    for (const int end : ends) {
        frame.take_samples(taken, end - taken);
        run_workers(frame, kernels);
        taken = end;
    }
    return frame.film();
}

bool same_bits(const Film& a, const Film& b) {
    return a.planes.size() == b.planes.size() &&
           std::equal(a.planes.begin(), a.planes.end(), b.planes.begin(), [](const Plane& x, const Plane& y) {
               return std::memcmp(x.values.data(), y.values.data(), x.values.size() * sizeof(float)) == 0;
           });
}

/// Tiles take turns in resting, so that all ways of keeping sums occur.
TEST(AdaptiveFrames, HaveTheBitsOfPassesTileByTile) {
    for (const auto& [filter, lod] :
         {std::pair{FilterKind::box, Lod::recursive}, std::pair{FilterKind::mitchell, Lod::camera}})
        for (const KernelTable* kernels : targets_with(true)) {
            const Scene scene = urchin(filter, lod);
            std::vector<Film> uniform{{}};
            for (const std::vector<int>& ends :
                 {std::vector{8}, std::vector{8, 16}, std::vector{8, 16, 22}, std::vector{8, 16, 22, 32}})
                uniform.push_back(in_passes(scene, ends, *kernels));
            Frame frame(scene, {.passes = true, .tile_passes = true});
            const std::vector<TilePlace> places = frame.tile_places(*kernels);
            constexpr std::array<int, 5> samples{0, 8, 16, 22, 32};
            // After each pass, the step that tiles of each of four kinds have come to.
            const std::vector<std::array<std::size_t, 4>> passes{{1, 1, 1, 1}, {2, 1, 2, 1}, {2, 1, 3, 2},
                                                                 {3, 2, 3, 2}, {4, 2, 4, 3}, {4, 3, 4, 3}};
            for (const auto& steps : passes) {
                std::vector<int> ends;
                for (std::size_t t = 0; t < places.size(); ++t)
                    ends.push_back(samples[steps[t % 4]]);
                frame.take_samples(*kernels, ends);
                run_workers(frame, *kernels);
                const Film film = frame.film();
                for (std::size_t t = 0; t < places.size(); ++t) {
                    const Film& expected = uniform[steps[t % 4]];
                    each_pixel(places[t], shown_part(scene.settings), [&](std::size_t i) {
                        ASSERT_EQ(film.find("samples")->values[i], static_cast<float>(ends[t]));
                        for (const Plane& plane : expected.planes) {
                            const float a = plane.values[i], b = film.find(plane.name)->values[i];
                            ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0)
                                << kernels->name << " " << plane.name << " tile " << t << " of " << ends[t];
                        }
                    });
                }
            }
        }
}

TEST(AdaptiveFrames, RefusePassesThatDoNotFollow) {
    Frame frame(urchin(FilterKind::box, Lod::fixed), {.passes = true, .tile_passes = true});
    const std::size_t tiles = frame.tile_places(best()).size();
    EXPECT_THROW(frame.take_samples(best(), std::vector<int>(tiles - 1, 8)), std::invalid_argument);
    frame.take_samples(best(), std::vector<int>(tiles, 8));
    EXPECT_THROW(frame.take_samples(best(), std::vector<int>(tiles, 7)), std::invalid_argument);
    EXPECT_THROW(frame.take_samples(8, 8), std::invalid_argument);
    frame.reset(); // one go again
    run_workers(frame, best());
    EXPECT_TRUE(same_bits(frame.film(), in_passes(urchin(FilterKind::box, Lod::fixed), {32}, best())));
    Frame other(urchin(FilterKind::box, Lod::fixed), {.passes = true});
    EXPECT_THROW(other.take_samples(best(), std::vector<int>(tiles, 8)), std::invalid_argument);
}

/// A shadow's edge on a floor, sky above: noise in places.
Scene noisy_scene(int width, int height, double threshold, int most) {
    Scene scene = small_default_scene(width, height);
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    scene.settings.samples = most;
    scene.settings.noise_threshold = threshold;
    return scene;
}

RenderResult render(const Scene& scene, RenderOptions options = {}) {
    if (options.threads == 0)
        options.threads = 1;
    return render_native(scene, options);
}

TEST(AdaptiveFrames, DoNotDependOnWhoRenders) {
    const Scene scene = noisy_scene(40, 32, 0.03, 96);
    const Film expected = render(scene).film;
    const std::vector<float>& samples = expected.find("samples")->values;
    EXPECT_LT(*std::min_element(samples.begin(), samples.end()),
              *std::max_element(samples.begin(), samples.end()));
    EXPECT_TRUE(same_bits(render(scene, {.threads = 3, .share = 2}).film, expected));
    EXPECT_TRUE(same_bits(render(scene, {.threads = 2, .tiles_in_rows = true}).film, expected));
    for (const KernelTable* kernels : targets_with(true))
        EXPECT_TRUE(same_bits(render(scene, {.kernels = kernels}).film, expected)) << kernels->name;
    bool rendered = false;
    for (std::uint64_t bytes = 256 << 10; !rendered; bytes = bytes * 5 / 4) {
        try {
            EXPECT_TRUE(same_bits(render(scene, {.memory_bytes = bytes}).film, expected));
            rendered = true;
        } catch (const UserError&) {
            // too little
        }
    }
}

TEST(AdaptiveFrames, AreThoseOfPassesWhereNothingIsQuiet) {
    Scene scene = noisy_scene(40, 32, 1e-9, 48);
    const RenderResult all = render(scene);
    Film expected = in_passes(scene, {8, 16, 32, 48}, best());
    for (const Plane& plane : expected.planes) {
        const std::vector<float>& values = all.film.find(plane.name)->values;
        std::size_t same = 0, noisy = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (all.film.find("samples")->values[i] == 48) {
                ++noisy;
                same += std::memcmp(&values[i], &plane.values[i], sizeof(float)) == 0 ? 1 : 0;
            }
        EXPECT_EQ(same, noisy) << plane.name;
        EXPECT_GT(noisy, values.size() / 2);
    }
    const PassFigures& figures = all.statistics.times.back().passes;
    EXPECT_EQ(figures.passes, 4);
    EXPECT_LT(figures.within_threshold, 0.5);
}

double luminance(const Film& film, std::size_t i) {
    return 0.2126 * double{film.find("R")->values[i]} + 0.7152 * double{film.find("G")->values[i]} +
           0.0722 * double{film.find("B")->values[i]};
}

TEST(AdaptiveFrames, AreAsQuietAsTheySay) {
    Scene scene = noisy_scene(96, 64, 0, 2048);
    scene.settings.lod = Lod::fixed; // else levels are those of the most samples
    scene.settings.seed = 77;
    const Film reference = render(scene).film;
    scene.settings.seed = 0;
    scene.settings.samples = 1024;
    for (const double threshold : {0.04, 0.015}) {
        scene.settings.noise_threshold = threshold;
        const RenderResult result = render(scene);
        const PassFigures& figures = result.statistics.times.back().passes;
        EXPECT_EQ(figures.within_threshold, 1);
        EXPECT_LT(figures.mean_samples, 0.7 * figures.samples) << "tiles need not differ";
        double squares = 0;
        std::size_t quiet = 0, tiles = 0;
        Frame frame(scene, {});
        for (const TilePlace& tile : frame.tile_places(best())) {
            double of_tile = 0, light = 0;
            each_pixel(tile, shown_part(scene.settings), [&](std::size_t i) {
                of_tile += std::pow(luminance(result.film, i) - luminance(reference, i), 2);
                light += luminance(reference, i);
            });
            squares += of_tile;
            ++tiles;
            quiet += std::sqrt(of_tile / light) <= 1.25 * threshold ? 1 : 0; // an estimate has noise too
        }
        EXPECT_GE(quiet, tiles * 97 / 100) << threshold;
        const double error = std::sqrt(squares / static_cast<double>(reference.pixel_count()));
        EXPECT_GT(figures.error / error, 0.85) << threshold;
        EXPECT_LT(figures.error / error, 1.6) << threshold;
        RecordProperty("told_over_true", std::to_string(figures.error / error));
    }
}

TEST(AdaptiveFrames, HaveTheirMeanWhereItIs) {
    Scene scene = noisy_scene(48, 32, 0, 1024);
    scene.settings.lod = Lod::fixed;
    const auto mean = [](const Film& film) {
        double sum = 0;
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            sum += luminance(film, i);
        return sum / static_cast<double>(film.pixel_count());
    };
    const double reference = mean(render(scene).film);
    scene.settings.noise_threshold = 0.06;
    double sum = 0, squares = 0;
    constexpr int pictures = 24;
    for (int seed = 1; seed <= pictures; ++seed) {
        scene.settings.seed = seed;
        const double one = mean(render(scene).film) / reference;
        sum += one;
        squares += one * one;
    }
    const double found = sum / pictures;
    const double off = std::sqrt((squares / pictures - found * found) / (pictures - 1));
    EXPECT_NEAR(found, 1, 3.5 * off);
    EXPECT_LT(off, 0.001) << "nothing was compared";
}

TEST(AdaptiveFrames, EndInTime) {
    Scene scene = noisy_scene(48, 32, 1e-6, 65536);
    const RenderResult result = render(scene, {.passes = {.seconds = 0.5}});
    const PassFigures& figures = result.statistics.times.back().passes;
    EXPECT_GE(figures.passes, 1);
    EXPECT_LT(figures.samples, 65536);
    EXPECT_LT(figures.within_threshold, 1);
}

TEST(AdaptiveFrames, NeedAChoice) {
    EXPECT_THROW(render(noisy_scene(16, 16, 0.1, pilot_samples)), UserError);
    RenderOptions layers;
    layers.layers.add(LayerGroup::pick);
    EXPECT_THROW(render(noisy_scene(16, 16, 0.1, 32), layers), UserError);
    EXPECT_THROW(render(noisy_scene(16, 16, 0.1, 32), {.frames = 2}), UserError);
}

} // namespace
} // namespace razor::test
