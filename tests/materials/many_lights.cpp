// Lights that are chosen from give what all of them give that have a ray each, in any picture, at any number
// of choices; their tree holds them all.
#include "tests/kernels/targets.h"
#include "tests/materials/parts.h"
#include "tests/materials/room.h"

#include "razor/frame/frame.h"
#include "razor/frame/light_tree.h"
#include "razor/native/render.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;

/// Of every kind, all about the room, bright and dim.
std::vector<Light> lights(int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<double>(random() >> 8U) / 16777216; };
    std::vector<Light> all;
    for (int n = 0; n < count; ++n) {
        Light l;
        l.position = l.corner = {next() * 3 - 1.5, next() * 2.6 + 0.3, next() * 3 - 1.5};
        l.direction = {next() - 0.5, next() * 0.6 - 0.8, next() - 0.5};
        l.radius = 0.05 + 0.15 * next();
        l.edge_u = {0.3 * next() + 0.05, 0, 0.1};
        l.edge_v = {0, 0.1 * next(), 0.3};
        l.cone_angle = 40;
        l.cone_delta = 15;
        const double power = 0.2 + 4 * next() * next();
        constexpr LightKind kinds[] = {LightKind::rectangle, LightKind::disk, LightKind::sphere,
                                       LightKind::point, LightKind::spot};
        l.kind = kinds[n % 5];
        const bool small = l.kind == LightKind::point || l.kind == LightKind::spot;
        l.radiance = glm::vec3(power * dvec3(next(), next(), next()) * (small ? 0.1 : 1.5));
        all.push_back(l);
    }
    return all;
}

void expect_same_light(const Scene& scene, int choices, const std::string& what) {
    for (const KernelTable* target : best_target()) {
        Scene each = scene, chosen = scene;
        each.settings.light_choices = 0;
        chosen.settings.light_choices = choices;
        chosen.settings.samples *= 4;
        const Parts want = parts_of(each, 6, target->name), seen = parts_of(chosen, 6, target->name);
        dvec3 all(0), all_seen(0);
        double noise = 0;
        for (std::size_t k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen.mean[k][c], want.mean[k][c],
                            5 * std::sqrt(want.variance[k][c] + seen.variance[k][c]) +
                                0.005 * want.mean[k][c])
                    << what << ", part " << k;
            all += want.mean[k];
            all_seen += seen.mean[k];
            noise += want.variance[k].y + seen.variance[k].y;
        }
        fmt::print("  {}, {} choices: {:+.2f} % (noise {:.2f} %)\n", what, choices,
                   100 * (all_seen.y / all.y - 1), 100 * std::sqrt(noise) / all.y);
        EXPECT_NEAR(all_seen.y / all.y, 1, 0.01) << what;
        EXPECT_LT(std::sqrt(noise) / all.y, 0.008) << what << ": noise hides mistakes";
    }
}

Scene lit_room(int count) {
    Scene s = room();
    s.lights = lights(count, 5);
    s.sky = {0, 0, 0};
    s.meshes.push_back(box("box", {-1.1, 0, -0.6}, {1, 1.2, 0.9}, 25, 0));
    s.settings.samples = 16;
    s.settings.light_samples = 1;
    return s;
}

TEST(ManyLights, MatteSurfaces) {
    for (const int choices : {1, 4})
        expect_same_light(lit_room(60), choices, "matte");
    Scene sun = lit_room(30);
    sun.lights.push_back({});
    sun.lights.back().kind = LightKind::directional;
    sun.lights.back().direction = {0.3, -1, -0.5};
    sun.lights.back().radiance = glm::vec3(0.5F);
    expect_same_light(sun, 2, "matte, and a sun");
}

TEST(ManyLights, WhatBouncesMeet) {
    for (const float roughness : {0.35F, 0.6F}) {
        Scene s = lit_room(40);
        s.meshes[1].material = 3;
        s.settings.samples = 32;
        s.meshes.push_back(ball("ball", {0.6, 0.7, 0.4}, 0.6, 3));
        s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = roughness;
        s.materials[0].specular = 1;
        s.materials[0].roughness = roughness;
        expect_same_light(s, 2, fmt::format("roughness {}", roughness));
    }
}

// Few have a ray each, as that is less noisy and as fast; so have all where nothing is asked for.
TEST(ManyLights, AreNotChosenWhereAllMayHaveARay) {
    Scene s = lit_room(24);
    s.settings.light_choices = 0;
    Frame none(s, {});
    EXPECT_EQ(none.header().light_choices, 0);
    EXPECT_EQ(none.header().light_nodes.get(), nullptr);
    s.settings.light_choices = 2;
    Frame few(s, {});
    EXPECT_EQ(few.header().light_choices, 0);
    EXPECT_EQ(few.header().light_count, 24);
    s.settings.light_choices = 1;
    Frame chosen(s, {});
    EXPECT_EQ(chosen.header().light_choices, 1);
    EXPECT_EQ(chosen.header().light_count, 0);
}

double angle_between(const float (&a)[3], const float (&b)[3]) {
    const double cosine = double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// Also ones whose squares are too small or too large.
TEST(ManyLights, DirectionsHaveAnyLength) {
    for (const Light& l : lights(40, 3))
        for (const double length : {1e-300, 1e-180, 3.0, 1e200}) {
            Light other = l;
            other.direction *= length;
            const LightBounds a = bounds_of(l, {1, 2, 3}), b = bounds_of(other, {1, 2, 3});
            EXPECT_LT(glm::distance(a.normals.axis, b.normals.axis), 1e-12) << length;
            EXPECT_LT(glm::distance(a.box.low, b.box.low) + glm::distance(a.box.high, b.box.high), 1e-12);
            EXPECT_EQ(a.normals.angle, b.normals.angle);
        }
}

TEST(ManyLights, TreesHoldAllLights) {
    for (const int count : {1, 2, 7, 300}) {
        const std::vector<Light> all = lights(count, 3);
        std::vector<LightBounds> bounds;
        for (const Light& l : all)
            bounds.push_back(bounds_of(l, {1, 2, 3}));
        const std::vector<LightNode> nodes = light_tree(bounds);
        ASSERT_EQ(nodes.size(), 2 * all.size() - 1);
        std::vector<int> found(all.size(), 0);
        std::vector<double> power(nodes.size(), 0);
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const LightNode& leaf = nodes[n];
            if (leaf.second >= 0) {
                const LightNode& second = nodes[static_cast<std::size_t>(leaf.second)];
                EXPECT_EQ(nodes[n + 1].parent, static_cast<int>(n));
                EXPECT_EQ(second.parent, static_cast<int>(n));
                EXPECT_EQ(nodes[n + 1].next, leaf.second);
                EXPECT_EQ(second.next, leaf.next);
                continue;
            }
            ++found[static_cast<std::size_t>(-1 - leaf.second)];
            EXPECT_EQ(leaf.next, static_cast<int>(n) + 1);
            for (int above = static_cast<int>(n); above >= 0;) {
                const LightNode& node = nodes[static_cast<std::size_t>(above)];
                power[static_cast<std::size_t>(above)] += double{leaf.power};
                for (int k = 0; k < 3; ++k) {
                    EXPECT_LE(node.low[k], leaf.low[k]);
                    EXPECT_GE(node.high[k], leaf.high[k]);
                }
                EXPECT_LE(node.cos_emission, leaf.cos_emission);
                const double within =
                    angle_between(node.axis, leaf.axis) + std::acos(double{leaf.cos_normals});
                EXPECT_GE(std::acos(double{node.cos_normals}) + 2e-3, std::min(within, std::numbers::pi));
                above = node.parent;
            }
        }
        for (std::size_t n = 0; n < nodes.size(); ++n)
            EXPECT_NEAR(double{nodes[n].power}, power[n], 1e-5 * power[n]);
        EXPECT_EQ(found, std::vector<int>(all.size(), 1));
    }
}

} // namespace
} // namespace razor::test
