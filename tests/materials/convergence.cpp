// Errors fall at least as the square root of the samples does, to pictures of many samples: no light is lost
// or found twice that few samples would not show.
#include "tests/kernels/targets.h"
#include "tests/materials/room.h"
#include "tests/materials/skies.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace razor::test {
namespace {

std::vector<double> picture(Scene scene, int samples, int seed) {
    scene.settings.samples = samples;
    scene.settings.seed = seed;
    RenderOptions options;
    options.threads = 2;
    const Film film = render_native(scene, options).film;
    std::vector<double> values;
    for (const char* name : {"R", "G", "B"})
        for (const float value : film.find(name)->values)
            values.push_back(double{value});
    return values;
}

/// Of the logarithm of the root mean square error over that of the samples, by least squares; the error at
/// the most.
struct Fit {
    double slope = 0, last = 0;
};
Fit fit(const Scene& scene) {
    constexpr int first_log2 = 2, last_log2 = 8, seeds = 4;
    std::vector<double> reference;
    for (int seed = 0; seed < 4; ++seed) {
        const std::vector<double> one = picture(scene, 2048, 1000 + seed);
        reference.resize(one.size(), 0);
        for (std::size_t i = 0; i < one.size(); ++i)
            reference[i] += one[i] / 4;
    }
    double mean = 0, n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const double value : reference)
        mean += value / static_cast<double>(reference.size());
    Fit f;
    for (int log2 = first_log2; log2 <= last_log2; ++log2) {
        double square = 0;
        for (int seed = 0; seed < seeds; ++seed) {
            const std::vector<double> one = picture(scene, 1 << log2, seed);
            for (std::size_t i = 0; i < one.size(); ++i)
                square += (one[i] - reference[i]) * (one[i] - reference[i]) /
                          static_cast<double>(one.size() * seeds);
        }
        f.last = std::sqrt(square) / mean;
        const double e = std::log2(f.last);
        n += 1;
        x += log2;
        y += e;
        xx += log2 * log2;
        xy += log2 * e;
    }
    f.slope = (n * xy - x * y) / (n * xx - x * x);
    return f;
}

Scene small_room() {
    Scene s = room();
    s.settings.width = s.settings.height = 8;
    s.settings.light_samples = s.settings.sky_samples = 1;
    return s;
}

void expect_converges(const Scene& scene, double error) {
    const Fit f = fit(scene);
    fmt::print("  {}: slope {:.3f}, relative error {:.4f} at 256 samples\n", scene.name, f.slope, f.last);
    EXPECT_LT(f.slope, -0.47) << scene.name;
    EXPECT_GT(f.slope, -1.1) << scene.name << ": too good: samples of the seeds are the reference's";
    EXPECT_LT(f.last, error) << scene.name;
}

TEST(Convergence, OfShadowsAndSky) {
    Scene s = small_room();
    s.name = "box, matte";
    s.meshes.push_back(box("box", {-1.1, 0, -0.6}, {1, 1.2, 0.9}, 25, 0));
    expect_converges(s, 0.02);
}

TEST(Convergence, OfPaths) {
    Scene s = small_room();
    s.name = "metal ball, lamp and mapped sky, 2 diffuse bounces";
    set_sky(s, sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.3, 5); }));
    s.meshes.push_back(ball("ball", {-0.4, 0.8, 0}, 0.8, 3));
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.4F;
    s.meshes.push_back(quad("lamp", {0.6, 0.2, -1.4}, {0.9, 0, 0.1}, {0, 0.8, 0.1}, 4));
    s.materials.push_back(named("lamp", {0.2F, 0.2F, 0.2F}));
    s.materials.back().emission = {2, 1, 0.5F};
    s.settings.diffuse_bounces = 2;
    expect_converges(s, 0.06);
}

} // namespace
} // namespace razor::test
