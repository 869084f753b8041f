// Under a sky of one radiance everywhere, a surface shows what it reflects and lets through of it in all:
// compared with integrals over its definition, for every lobe, at every angle, on every target.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"
#include "tests/materials/plain_surface.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

using glm::dvec3;

struct Case {
    const char* name;
    Material material;
};

Material material(float metallic, float roughness, float specular, glm::vec3 albedo = {0.8F, 0.5F, 0.2F}) {
    Material m;
    m.name = "tested";
    m.albedo = albedo;
    m.metallic = metallic;
    m.roughness = roughness;
    m.specular = specular;
    return m;
}

std::vector<Case> cases() {
    std::vector<Case> all = {
        {"mirror", material(1, 0, 0)},      {"smooth metal", material(1, 0.1F, 0)},
        {"metal", material(1, 0.4F, 0)},    {"rough metal", material(1, 1, 0)},
        {"plastic", material(0, 0.3F, 1)},  {"rough plastic", material(0, 0.9F, 1)},
        {"dense", material(0, 0.5F, 0.7F)}, {"half metal", material(0.5F, 0.5F, 1)},
    };
    all[6].material.ior = 2.4F;
    all.push_back({"coated paint", material(0, 0.6F, 0)});
    all.back().material.coat = 0.8F;
    all.back().material.coat_roughness = 0.2F;
    all.push_back({"coated metal", material(1, 0.7F, 0)});
    all.back().material.coat = 1;
    all.push_back({"glass", material(0, 0, 1, {1, 0.9F, 0.8F})});
    all.back().material.transmission = 1;
    all.push_back({"frosted glass", material(0, 0.5F, 1, {0.9F, 0.9F, 1})});
    all.back().material.transmission = 1;
    all.push_back({"half clear", material(0.2F, 0.4F, 1)});
    all.back().material.transmission = 0.6F;
    all.back().material.coat = 0.5F;
    all.back().material.coat_roughness = 0.4F;
    const auto add_sheen = [&](const char* name, Material m, const glm::vec3& sheen, float roughness) {
        m.sheen = sheen;
        m.sheen_roughness = roughness;
        all.push_back({name, m});
    };
    add_sheen("velvet", material(0, 0.5F, 0, {0.1F, 0, 0}), {0.9F, 0.5F, 0.7F}, 0.3F);
    add_sheen("felt", material(0, 0.5F, 0), {1, 0.9F, 0.8F}, 0.8F);
    add_sheen("satin", material(0, 0.4F, 1), glm::vec3(0.6F), 0.15F);
    add_sheen("dusty metal", material(1, 0.3F, 0), glm::vec3(1), 1);
    add_sheen("coated cloth", material(0, 0.5F, 1), {0.2F, 0.9F, 0.4F}, 0.5F);
    all.back().material.coat = 0.7F;
    all.back().material.coat_roughness = 0.3F;
    add_sheen("gauze", material(0, 0.3F, 1, {0.9F, 0.9F, 1}), {0.8F, 0.8F, 0.3F}, 0.6F);
    all.back().material.transmission = 1;
    return all;
}

TEST(Furnace, EqualsIntegralsOverTheDefinition) {
    for (const Case& one : cases())
        for (const double angle : {10.0, 45.0, 80.0}) {
            Scene scene = seen_floor(one.material, angle);
            scene.sky = glm::vec3(1);
            scene.settings.samples = 256;
            scene.settings.bounces = 1;
            const PlainSurface plain(one.material);
            const dvec3 expected =
                plain.reflected(view_at(angle), 256) + plain.transmitted(view_at(angle), 256);
            for (const KernelTable* target : best_target()) {
                const dvec3 seen = mean_colour(scene, target->name);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c], expected[c], 0.004 + 0.004 * expected[c])
                        << one.name << " at " << angle << " degrees, " << target->name << ", colour " << c;
            }
        }
}

// Nothing reflects more than it gets, whichever way it is looked at.
TEST(Furnace, NoSurfaceGivesMoreThanItGets) {
    for (Case& one : cases()) {
        one.material.albedo = glm::vec3(1);
        for (const double angle : {1.0, 30.0, 60.0, 75.0, 85.0, 89.0}) {
            Scene scene = seen_floor(one.material, angle);
            scene.sky = glm::vec3(1);
            scene.settings.samples = has_sheen(one.material) ? 1024 : 64; // at grazing angles few find much
            scene.settings.bounces = 1;
            const dvec3 seen = mean_colour(scene, native_targets().back()->name);
            EXPECT_LT(seen.x, 1.003) << one.name << " at " << angle << " degrees";
        }
    }
}

// What a mirror or clear glass does not reflect comes through, whatever the way: in a furnace both vanish.
TEST(Furnace, ClearGlassAndMirrorsVanish) {
    for (const bool clear : {false, true}) {
        Scene scene = scene_of(torus_cage(6, 5), 40);
        Material m = material(clear ? 0 : 1, 0, 1, glm::vec3(1));
        m.transmission = clear ? 1 : 0;
        scene.materials = {m};
        scene.lights.clear();
        scene.sky = glm::vec3(1);
        scene.settings.samples = 16;
        scene.settings.bounces = 64;
        for (const KernelTable* target : best_target()) {
            const dvec3 seen = mean_colour(scene, target->name);
            for (int c = 0; c < 3; ++c) // a little stays within, or meets normals that disagree
                EXPECT_NEAR(seen[c], 1, 0.01) << (clear ? "glass" : "mirror") << ", " << target->name;
        }
    }
}

} // namespace
} // namespace razor::test
