// Lights of every kind, on every target: what arrives at a point of a plane is what closed forms say, shadows
// fall where something is in the way and nowhere else.
#include "tests/kernels/targets.h"

#include "razor/frame/unit.h"
#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

Mesh square(const dvec3& middle, double half) {
    Mesh m;
    m.name = "square";
    m.scheme = Scheme::bilinear;
    m.points = {middle + dvec3(-half, 0, -half), middle + dvec3(-half, 0, half),
                middle + dvec3(half, 0, half), middle + dvec3(half, 0, -half)};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    m.edge_length = half;
    return m;
}

/// A white floor, and a camera all of whose pixels look at the origin on it.
Scene lit_floor(const Light& light) {
    Scene s;
    s.name = "floor";
    s.meshes = {square(dvec3(0), 20)};
    s.materials = {{"white", glm::vec3(1)}};
    s.lights = {light};
    s.camera.position = {0.4, 6, 5};
    s.camera.target = {0, 0, 0};
    s.camera.fov_degrees = 0.001;
    s.settings = {
        .lod = Lod::fixed, .width = 8, .height = 8, .samples = 1, .light_samples = 64, .sky_samples = 0};
    return s;
}

struct Lit {
    dvec3 irradiance{0}; // mean of all pixels
    std::int64_t rays = 0;
};

Lit lit(const Scene& scene, const std::string& target) {
    RenderOptions options;
    options.threads = 1;
    options.isa = target;
    const RenderResult result = render_native(scene, options);
    Lit lit;
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>& plane = result.film.find(names[c])->values;
        for (const float value : plane)
            lit.irradiance[c] += value * pi / static_cast<double>(plane.size());
    }
    lit.rays = result.statistics.frame.by_kind.kind[kind_light].rays;
    return lit;
}

/// On every native target.
void expect_irradiance(const Scene& scene, const dvec3& expected, double relative, const std::string& what) {
    for (const KernelTable* target : native_targets()) {
        const Lit got = lit(scene, target->name);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(got.irradiance[c], expected[c], relative * expected[c])
                << what << ", " << target->name;
    }
}

const dvec3 place(1, 2, -1); // of lights, above the floor to one side
const glm::vec3 emitted(3, 6, 9);

Light light_at_place(LightKind kind) {
    Light light;
    light.kind = kind;
    light.position = place;
    light.radiance = emitted;
    return light;
}

double cosine_at_origin() {
    return place.y / glm::length(place);
}

TEST(LightKinds, PointsFollowTheInverseSquare) {
    const double apart = glm::dot(place, place);
    const Scene scene = lit_floor(light_at_place(LightKind::point));
    expect_irradiance(scene, dvec3(emitted) * (cosine_at_origin() / apart), 1e-4, "point");
    EXPECT_EQ(lit(scene, native_targets().front()->name).rays, 64) << "one ray a hit tells all";
    Light below = light_at_place(LightKind::point);
    below.position.y = -2;
    expect_irradiance(lit_floor(below), dvec3(0), 0, "below");
}

TEST(LightKinds, SpotsFallOffWithinTheirCone) {
    const double apart = glm::dot(place, place);
    const dvec3 axis = -glm::normalize(place);
    const dvec3 across = glm::normalize(glm::cross(axis, dvec3(0, 0, 1)));
    const dvec3 whole = dvec3(emitted) * (cosine_at_origin() / apart);
    Light spot = light_at_place(LightKind::spot);
    spot.cone_angle = 40;
    spot.cone_delta = 20;
    const double end = std::cos(glm::radians(40.0)), begin = std::cos(glm::radians(20.0));
    for (const auto& [cosine, share] : {std::pair{1.0, 1.0},
                                        {begin + 1e-3, 1.0},
                                        {(begin + end) / 2, 0.5},
                                        {begin + (end - begin) * 0.75, 0.25 * 0.25 * (3 - 2 * 0.25)},
                                        {end - 1e-3, 0.0},
                                        {-1.0, 0.0}}) {
        spot.direction = 7.0 * (cosine * axis + std::sqrt(1 - cosine * cosine) * across);
        expect_irradiance(lit_floor(spot), share * whole, 1e-3, "cosine " + std::to_string(cosine));
    }
    spot.cone_delta = 0;
    spot.direction = axis + 0.1 * across;
    expect_irradiance(lit_floor(spot), whole, 1e-4, "sharp");
    // Of a cone too narrow for cosines of 24 bits: whole on its axis, half in the middle of its fall, none
    // beyond.
    spot.cone_angle = 0.02;
    spot.cone_delta = 0.01;
    const auto square_of = [](double degrees) { return glm::radians(degrees) * glm::radians(degrees); };
    const double middle = std::sqrt((square_of(0.01) + square_of(0.02)) / 2);
    for (const auto& [angle, share] : {std::pair{0.0, 1.0}, {middle, 0.5}, {glm::radians(0.025), 0.0}}) {
        spot.direction = std::cos(angle) * axis + std::sin(angle) * across;
        Scene scene = lit_floor(spot);
        scene.camera.fov_degrees = 1e-5;
        scene.meshes.front() = square(dvec3(0), 0.1); // from which rays begin no further than a part of that
        expect_irradiance(scene, share * whole, 2e-2, "narrow, angle " + std::to_string(angle));
    }
}

TEST(LightKinds, DirectionalLightIsTheSameEverywhere) {
    Light sun = light_at_place(LightKind::directional);
    sun.direction = {3, -6, 2};
    const double cosine = 6.0 / 7.0;
    Scene scene = lit_floor(sun);
    expect_irradiance(scene, dvec3(emitted) * cosine, 1e-5, "sharp");
    EXPECT_EQ(lit(scene, native_targets().front()->name).rays, 64) << "one ray a hit tells all";
    for (dvec3* p : {&scene.camera.position, &scene.camera.target})
        *p += dvec3(11, 0, -13);
    expect_irradiance(scene, dvec3(emitted) * cosine, 1e-5, "elsewhere");
    sun.angular_radius = 25; // all of it above the horizon
    expect_irradiance(lit_floor(sun), dvec3(emitted) * cosine, 2e-3, "wide");
    EXPECT_EQ(lit(lit_floor(sun), native_targets().front()->name).rays, 64 * 64);
    sun.angular_radius = 0.267;
    expect_irradiance(lit_floor(sun), dvec3(emitted) * cosine, 1e-4, "sun");
    sun.direction = {1, 2, 3};
    expect_irradiance(lit_floor(sun), dvec3(0), 0, "from below");
}

TEST(LightKinds, DisksLightWhatIsInFrontOfThem) {
    Light disk = light_at_place(LightKind::disk);
    disk.position = {0, 3, 0};
    disk.radius = 2;
    expect_irradiance(lit_floor(disk), dvec3(emitted) * (pi * 4 / (9 + 4)), 3e-3, "above");
    disk.direction = {0, 5, 0};
    expect_irradiance(lit_floor(disk), dvec3(0), 0, "turned away");
    // Small and anywhere: a point of intensity L A cos.
    disk.position = place;
    disk.radius = 0.01;
    disk.direction = {0.3, -1, 0.2};
    const double apart = glm::dot(place, place);
    const double cosine = glm::dot(glm::normalize(disk.direction), -glm::normalize(place));
    expect_irradiance(lit_floor(disk), dvec3(emitted) * (pi * 1e-4 * cosine * cosine_at_origin() / apart),
                      1e-3, "small");
}

TEST(LightKinds, SpheresLightAsTheirSolidAngleDoes) {
    Light sphere = light_at_place(LightKind::sphere);
    const double apart = glm::dot(place, place);
    for (const double radius : {1.2, 0.5, 1e-3}) { // all of it above the horizon
        sphere.radius = radius;
        expect_irradiance(lit_floor(sphere),
                          dvec3(emitted) * (pi * radius * radius / apart * cosine_at_origin()), 2e-3,
                          "radius " + std::to_string(radius));
    }
    sphere.radius = 4;
    expect_irradiance(lit_floor(sphere), dvec3(0), 0, "from within");
}

/// A small screen `share` of the way from the origin to the light.
Scene screened(const Light& light, double share, double half) {
    Scene scene = lit_floor(light);
    scene.meshes.push_back(square(share * place, half));
    return scene;
}

TEST(LightKinds, ShadowsEndAtTheLight) {
    for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::disk, LightKind::sphere}) {
        Light light = light_at_place(kind);
        light.direction = -place;
        light.radius = 0.2;
        const std::string name = "kind " + std::to_string(static_cast<int>(kind));
        const dvec3 open = lit(lit_floor(light), native_targets().front()->name).irradiance;
        EXPECT_GT(open.x, 0.01) << name;
        expect_irradiance(screened(light, 0.5, 0.4), dvec3(0), 0, name);
        expect_irradiance(screened(light, 1.3, 0.4), open, 1e-6, name + " before the screen");
        if (kind == LightKind::sphere)
            expect_irradiance(screened(light, 1.0, 0.05), open, 1e-6, "a screen in it");
    }
    Light sun = light_at_place(LightKind::directional);
    sun.direction = -place;
    expect_irradiance(screened(sun, 5, 0.2), dvec3(0), 0, "however far");
}

TEST(LightKinds, PicturesDoNotDependOnTheUnitOfLength) {
    for (int kind = 0; kind < 6; ++kind) {
        Light light = light_at_place(static_cast<LightKind>(kind));
        light.direction = -place;
        light.corner = {1, 3, 1};
        light.edge_u = {2, 0, 0}; // it looks down
        light.edge_v = {0, 0, 2};
        light.radius = 0.5;
        Scene scene = lit_floor(light);
        scene.settings.light_samples = 4;
        const dvec3 usual = lit(scene, native_targets().front()->name).irradiance;
        EXPECT_GT(usual.y, 0) << kind;
        expect_irradiance(scaled(scene, std::ldexp(1.0, 5)), usual, 1e-5, "kind " + std::to_string(kind));
        // So far out of range that the frame takes a unit of its own.
        expect_irradiance(scaled(scene, std::ldexp(1.0, -45)), usual, 1e-5,
                          "tiny, kind " + std::to_string(kind));
    }
}

} // namespace
} // namespace razor::test
