// Light that lies close by: rays to its points find much of it now and then, bounces in all directions find
// it evenly. Where both go the light is the same and the noise less.
#include "tests/kernels/targets.h"
#include "tests/materials/parts.h"
#include "tests/materials/room.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

/// A floor, alone: nothing that it reflects comes back to it.
Scene bare_floor() {
    Scene s = room();
    s.lights.clear();
    s.sky = {0, 0, 0};
    s.meshes.resize(1);
    s.settings.samples = 256;
    s.settings.light_samples = 1;
    s.settings.bounces = 1;
    return s;
}

/// Low above the floor, seen from all of it edge on.
Light strip(double x) {
    Light l;
    l.kind = LightKind::rectangle;
    l.corner = {x, 0.004, -1.5};
    l.edge_u = {0, 0, 3};
    l.edge_v = {0, 0.3, 0};
    l.radiance = {3, 2, 1};
    return l;
}

void expect_quieter(const Scene& scene, const std::string& what, double times) {
    for (const KernelTable* target : best_target()) {
        Scene both = scene;
        both.settings.diffuse_bounces = 1;
        const Parts alone = parts_of(scene, 40, target->name), seen = parts_of(both, 40, target->name);
        double light = 0, light_seen = 0, noise = 0, noise_seen = 0;
        for (std::size_t k = 0; k < 16; ++k) {
            light += alone.mean[k].y;
            light_seen += seen.mean[k].y;
            noise += alone.variance[k].y;
            noise_seen += seen.variance[k].y;
        }
        const double error = std::sqrt(noise + noise_seen);
        fmt::print("  {}: {:+.2f} % (noise {:.2f} %), variance 1/{:.1f}\n", what,
                   100 * (light_seen / light - 1), 100 * error / light, noise / noise_seen);
        EXPECT_NEAR(light_seen, light, 4 * error) << what;
        EXPECT_LT(error, 0.02 * light) << what << ": noise hides mistakes";
        EXPECT_GT(noise, times * noise_seen) << what;
    }
}

TEST(NearLights, WithRaysOfTheirOwn) {
    Scene s = bare_floor();
    s.lights = {strip(0.2)};
    expect_quieter(s, "a light", 2);
}

TEST(NearLights, AmongMany) {
    Scene s = bare_floor();
    s.settings.light_choices = 1;
    for (int k = 0; k < 14; ++k)
        s.lights.push_back(strip(-1.4 + 0.2 * k));
    expect_quieter(s, "one of 14 lights", 1.5);
}

TEST(NearLights, ThatAreSurfaces) {
    Scene s = bare_floor();
    s.meshes.push_back(quad("lamp", {0.2, 0.004, -1.5}, {0, 0, 3}, {0, 0.3, 0}, 3));
    s.materials.push_back(named("lamp", {0, 0, 0}));
    s.materials.back().emission = {3, 2, 1};
    s.materials.back().light = true;
    expect_quieter(s, "a mesh", 2);
}

// Rays go to those that matter where they leave: a lamp far away that emits much more leaves its share of the
// light as quiet as it was.
TEST(NearLights, ThatAreSurfacesWithBrightOnesFarAway) {
    Scene s = bare_floor();
    s.meshes.push_back(quad("lamp", {-0.2, 0.8, -0.2}, {0.4, 0, 0}, {0, 0, 0.4}, 3)); // its front down
    s.materials.push_back(named("lamp", {0, 0, 0}));
    s.materials.back().emission = {3, 2, 1};
    s.materials.back().light = true;
    s.materials.back().two_sided = false; // unseen
    const Parts alone = parts_of(s, 24);
    s.meshes.push_back(ball("beacon", {-30, 60, -30}, 6, 3));
    const Parts both = parts_of(s, 24);
    double light = 0, light_of_both = 0, noise = 0, noise_of_both = 0;
    for (std::size_t k = 0; k < 16; ++k) {
        noise += alone.variance[k].y;
        noise_of_both += both.variance[k].y;
        light += alone.mean[k].y;
        light_of_both += both.mean[k].y;
    }
    EXPECT_GT(light_of_both, 1.02 * light);
    fmt::print("  light {:.2f} times and variance {:.2f} times that of one lamp\n", light_of_both / light,
               noise_of_both / noise);
    // Where rays go by area and radiance alone it is 300,000 times.
    EXPECT_LT(noise_of_both, 100 * noise);
}

TEST(NearLights, OverFabric) {
    Scene s = bare_floor();
    s.lights = {strip(0.2)};
    s.materials[0].sheen = {0.9F, 0.9F, 0.9F};
    s.materials[0].sheen_roughness = 0.5F;
    expect_quieter(s, "a light over fabric", 2);
}

} // namespace
} // namespace razor::test
