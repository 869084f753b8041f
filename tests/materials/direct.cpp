// One point of a floor under one light: what lobes reflect of it is the integral over the light, whether rays
// to the light find it, rays that bounce, or both.
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"
#include "tests/materials/plain_surface.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double angle = 40;
constexpr int grid = 300;

/// The way that a mirror reflects the viewer's rays; the floor's system.
dvec3 mirrored() {
    dvec3 v = view_at(angle);
    return {-v.x, -v.y, v.z};
}

struct Lit {
    const char* name;
    Light light;
    /// Calls visit(direction, irradiance on a plane facing it of radiance 1 there, share) over the light.
    std::function<void(const std::function<void(const dvec3&, double)>&)> over;
};

/// Towards any light: x, y of the plane across `axis`.
dvec3 about(const dvec3& axis, const dvec3& p) {
    const dvec3 x = glm::normalize(glm::cross(dvec3(0, 1, 0), axis)), y = glm::cross(axis, x);
    return x * p.x + y * p.y + axis * p.z;
}

Lit rectangle() {
    const dvec3 axis = mirrored(), middle = 5.0 * axis + about(axis, {0.6, 0.2, 0});
    const dvec3 u = about(axis, {2, 0.3, 0}), v = about(axis, {0.2, 1.5, 0});
    Light l;
    l.kind = LightKind::rectangle;
    l.corner = to_scene(middle - 0.5 * (u + v));
    l.edge_u = to_scene(v); // emits towards -axis
    l.edge_v = to_scene(u);
    l.radiance = {3, 2, 1};
    return {"rectangle", l, [=](const auto& visit) {
                const double area = glm::length(glm::cross(u, v));
                for (int i = 0; i < grid; ++i)
                    for (int j = 0; j < grid; ++j) {
                        const dvec3 p = middle + ((i + 0.5) / grid - 0.5) * u + ((j + 0.5) / grid - 0.5) * v;
                        const double square = glm::dot(p, p);
                        const dvec3 to = p / std::sqrt(square);
                        visit(to, area * glm::dot(axis, to) / square / (grid * grid));
                    }
            }};
}

Lit disk() {
    const dvec3 axis = mirrored(), middle = 4.0 * axis + about(axis, {0, 0.3, 0});
    Light l;
    l.kind = LightKind::disk;
    l.position = to_scene(middle);
    l.direction = to_scene(-axis);
    l.radius = 0.8;
    l.radiance = {3, 2, 1};
    return {"disk", l, [=](const auto& visit) {
                for (int i = 0; i < grid; ++i)
                    for (int j = 0; j < grid; ++j) {
                        const double r = 0.8 * std::sqrt((i + 0.5) / grid), phi = 2 * pi * (j + 0.5) / grid;
                        const dvec3 p = middle + about(axis, {r * std::cos(phi), r * std::sin(phi), 0});
                        const double square = glm::dot(p, p);
                        const dvec3 to = p / std::sqrt(square);
                        visit(to, pi * 0.64 * glm::dot(axis, to) / square / (grid * grid));
                    }
            }};
}

/// All directions whose 1 - cos to the axis is at most that, of one radiance.
auto over_cone(const dvec3& axis, double versine) {
    return [=](const auto& visit) {
        for (int i = 0; i < grid; ++i)
            for (int j = 0; j < grid; ++j) {
                const double z = 1 - versine * (i + 0.5) / grid, s = std::sqrt(1 - z * z);
                const double phi = 2 * pi * (j + 0.5) / grid;
                visit(about(axis, {s * std::cos(phi), s * std::sin(phi), z}),
                      2 * pi * versine / (grid * grid));
            }
    };
}

Lit sphere() {
    const dvec3 axis = glm::normalize(mirrored() + dvec3(0.05, 0.1, 0));
    Light l;
    l.kind = LightKind::sphere;
    l.position = to_scene(4.0 * axis);
    l.radius = 1;
    l.radiance = {3, 2, 1};
    return {"sphere", l, over_cone(axis, 1 - std::sqrt(1 - 1.0 / 16))};
}

Lit directional() {
    const dvec3 axis = glm::normalize(mirrored() + dvec3(0, 0.04, 0));
    const double radius = glm::radians(6.0);
    Light l;
    l.kind = LightKind::directional;
    l.direction = to_scene(-axis);
    l.angular_radius = 6;
    l.radiance =
        glm::vec3(3, 2, 1) * static_cast<float>(pi * std::sin(radius) * std::sin(radius)); // irradiance
    return {"directional", l, over_cone(axis, 1 - std::cos(radius))};
}

Lit point() {
    const dvec3 at = 5.0 * glm::normalize(mirrored() + dvec3(0.1, 0.05, 0));
    Light l;
    l.kind = LightKind::point;
    l.position = to_scene(at);
    l.radiance = {30, 20, 10};
    return {"point", l, [=](const auto& visit) { visit(glm::normalize(at), 10.0 / glm::dot(at, at)); }};
}

Material material(float metallic, float roughness, float coat) {
    Material m;
    m.name = "tested";
    m.albedo = {0.8F, 0.5F, 0.2F};
    m.metallic = metallic;
    m.roughness = roughness;
    m.specular = 1;
    m.coat = coat;
    m.coat_roughness = 0.25F;
    return m;
}

dvec3 expected(const Lit& lit, const Material& m) {
    const PlainSurface plain(m);
    const dvec3 v = view_at(angle), radiance(3, 2, 1);
    dvec3 sum(0);
    lit.over([&](const dvec3& to, double share) {
        if (to.z > 0)
            sum += radiance * plain.reflectance(v, to) * (to.z * share);
    });
    return sum;
}

void expect_seen(const Lit& lit, const Material& m, int bounces, int light_samples, double tolerance) {
    Scene scene = seen_floor(m, angle);
    scene.lights = {lit.light};
    scene.settings.samples = 256;
    scene.settings.light_samples = light_samples;
    scene.settings.bounces = bounces;
    const dvec3 all = expected(lit, m);
    for (const KernelTable* target : best_target()) {
        dvec3 error;
        const dvec3 seen = mean_colour(scene, target->name, &error);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c], all[c], tolerance * all[c] + 3 * error[c])
                << lit.name << ", roughness " << m.roughness << ", metallic " << m.metallic << ", coat "
                << m.coat << ", " << bounces << " bounces, " << light_samples << " light samples, "
                << target->name;
        EXPECT_LT(error.x, 0.05 * all.x) << "noise hides mistakes: " << lit.name << ' ' << m.roughness;
    }
}

TEST(DirectLight, IsTheIntegralOverTheLight) {
    for (const Lit& lit : {rectangle(), disk(), sphere(), directional(), point()})
        for (const float roughness : {0.15F, 0.4F, 1.0F})
            for (const float metallic : {0.0F, 1.0F})
                for (const float coat : {0.0F, 1.0F})
                    for (const int samples : {1, 4})
                        expect_seen(lit, material(metallic, roughness, coat), 1, samples, 0.005);
}

// Rays to the light alone give the same, where lobes are wide enough for them.
TEST(DirectLight, ByTheLightsSamplesAloneIsTheSame) {
    for (const Lit& lit : {rectangle(), disk(), sphere(), directional(), point()})
        for (const float roughness : {0.5F, 1.0F})
            expect_seen(lit, material(0.3F, roughness, 0.5F), 0, 4, 0.005);
}

// A mirror shows the light itself.
TEST(DirectLight, MirrorsShowLights) {
    for (const Lit& lit : {rectangle(), disk(), sphere(), directional()})
        for (const float metallic : {0.0F, 1.0F}) {
            Material m = material(metallic, 0, 0);
            m.albedo = metallic > 0 ? m.albedo : glm::vec3(0);
            Scene scene = seen_floor(m, angle);
            scene.lights = {lit.light};
            scene.settings.samples = 256;
            const dvec3 shown = dvec3(3, 2, 1) * PlainSurface(m).base_fresnel(std::cos(glm::radians(angle)));
            for (const KernelTable* target : best_target()) {
                const dvec3 seen = mean_colour(scene, target->name);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c], shown[c], 0.02 * shown[c])
                        << lit.name << ", metallic " << metallic << ", " << target->name;
            }
        }
}

// A surface that emits as much as a light does lights what reflects it likewise: found by bounces alone.
TEST(DirectLight, EmissionOfASurfaceIsTheLightOfALight) {
    const Lit lit = rectangle();
    for (const float roughness : {0.0F, 0.3F, 0.8F}) {
        Material metal = material(1, roughness, 0), lamp;
        lamp.name = "lamp";
        lamp.albedo = glm::vec3(0);
        lamp.emission = {3, 2, 1};
        Scene scene = seen_floor(metal, angle);
        Mesh m = scene.meshes[0];
        const Light& l = lit.light;
        m.name = "lamp";
        m.points = {l.corner, l.corner + l.edge_u, l.corner + l.edge_u + l.edge_v, l.corner + l.edge_v};
        m.edge_length = 2;
        m.material = 1;
        scene.meshes.push_back(m);
        scene.materials.push_back(lamp);
        scene.settings.samples = 1024;
        Scene with_light = seen_floor(metal, angle);
        with_light.lights = {l};
        with_light.settings.samples = 256;
        for (const KernelTable* target : best_target()) {
            dvec3 error, other_error;
            const dvec3 seen = mean_colour(scene, target->name, &error);
            const dvec3 other = mean_colour(with_light, target->name, &other_error);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c], other[c], 0.003 * other[c] + 3 * (error[c] + other_error[c]))
                    << roughness << ' ' << target->name;
            EXPECT_LT(error.x + other_error.x, 0.02 * other.x) << "noise hides mistakes";
        }
    }
}

} // namespace
} // namespace razor::test
