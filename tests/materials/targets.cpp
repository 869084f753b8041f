// Paths of light, textures and a map of the sky are the same on every target that fuses, to the last bit, and
// nearly so on the one that does not.
#include "tests/kernels/targets.h"
#include "tests/materials/room.h"
#include "tests/materials/skies.h"

#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

Scene everything() {
    Scene s = room();
    set_sky(s, sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.2, 20); }));
    s.textures.push_back(sky_texture(16, 16, [](double u, double v) { return glm::vec3(u, v, 0.5); }));
    s.meshes[0].texcoords = {{0, 0}, {3, 0}, {3, 2}, {0, 2}};
    s.meshes[0].face_texcoords = {0, 1, 2, 3};
    s.materials[0].albedo_map.texture = s.materials[0].normal_map.texture = 1;
    s.materials[0].coat = 0.5F;
    s.materials[0].coat_roughness = 0.2F;
    s.meshes.push_back(ball("ball", {-0.4, 0.8, 0}, 0.8, 3));
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.4F;
    s.meshes.push_back(box("glass", {0.3, 0.1, 0.6}, {0.7, 0.9, 0.6}, 30, 4));
    s.materials.push_back(named("glass", {0.9F, 1, 0.9F}));
    s.materials.back().specular = s.materials.back().transmission = 1;
    s.materials.back().roughness = 0.1F;
    s.settings.samples = 4;
    s.settings.diffuse_bounces = 1;
    return s;
}

std::vector<float> picture(const Scene& scene, const KernelTable* target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target->name;
    const Film film = render_native(scene, options).film;
    std::vector<float> values;
    for (const Plane& plane : film.planes)
        values.insert(values.end(), plane.values.begin(), plane.values.end());
    return values;
}

TEST(TargetsOfPaths, ShowTheSame) {
    const Scene scene = everything();
    const std::vector<float> best = picture(scene, native_targets().back());
    for (const KernelTable* target : native_targets()) {
        const std::vector<float> values = picture(scene, target);
        ASSERT_EQ(values.size(), best.size());
        if (std::string(target->name) != "sse4") {
            EXPECT_EQ(values, best) << target->name;
            continue;
        }
        double sum = 0, difference = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (std::isfinite(best[i])) {
                sum += std::abs(double{best[i]});
                difference += std::abs(double{values[i]} - best[i]);
            }
        EXPECT_LT(difference, 0.02 * sum) << target->name; // few paths part by a last bit
    }
}

} // namespace
} // namespace razor::test
