// Pictures through a thin lens against closed forms, and what its rays ask for.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"
#include "razor/frame/view.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace razor::test {
namespace {

constexpr int width = 64, height = 4;
constexpr double depth = 4;

/// A half plane x < 0 at `depth` before a lens of radius 0.2, across the film.
Scene half_plane(double focus) {
    Mesh m;
    m.name = "half plane";
    m.scheme = Scheme::bilinear;
    m.points = {{-9, -9, -depth}, {0, -9, -depth}, {0, 9, -depth}, {-9, 9, -depth}};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    Scene scene;
    scene.name = m.name;
    scene.meshes = {m};
    scene.materials = {{.name = "white", .albedo = glm::vec3(1)}};
    scene.camera.position = {0, 0, 0};
    scene.camera.target = {0, 0, -1};
    scene.camera.fov_degrees = 2 * std::atan(0.5 / depth * height / width) * 180 / std::numbers::pi;
    scene.camera.aperture_radius = 0.2;
    scene.camera.focus_distance = focus;
    scene.settings.width = width;
    scene.settings.height = height;
    scene.settings.samples = 2048;
    return scene;
}

std::vector<float> albedo_of(const Scene& scene) {
    Frame frame(scene, {});
    frame.render(*native_targets().back(), 0);
    const FrameHeader& h = frame.header();
    const float* values = h.film.get() + static_cast<std::ptrdiff_t>(h.width) * h.height * film_albedo;
    return {values, values + static_cast<std::ptrdiff_t>(h.width) * h.height};
}

/// Part of a disk of radius r about x where x < 0.
double covered(double x, double r) {
    const double a = std::clamp(x / r, -1.0, 1.0);
    return (std::acos(a) - a * std::sqrt(1 - a * a)) / std::numbers::pi;
}

TEST(Lens, BlursAnEdgeByItsCircleOfConfusion) {
    for (double focus : {1.6, 2.5, 4.0, 5.0, 16.0})
        for (Lod lod : {Lod::fixed, Lod::recursive}) {
            Scene scene = half_plane(focus);
            scene.settings.lod = lod;
            const std::vector<float> albedo = albedo_of(scene);
            const double radius = 0.2 * std::abs(1 - depth / focus), pixel = 1.0 / width;
            for (int i = 0; i < width * height; ++i) {
                const double x = (i % width + 0.5) * pixel - 0.5;
                double expected = x < 0 ? 1 : 0; // the edge lies between two pixels
                if (radius > 0) {
                    expected = 0;
                    for (int k = 0; k < 16; ++k)
                        expected += covered(x + ((k + 0.5) / 16 - 0.5) * pixel, radius) / 16;
                }
                EXPECT_NEAR(albedo[static_cast<std::size_t>(i)], expected, radius > 0 ? 0.015 : 0)
                    << "focus " << focus << ", pixel " << i;
            }
        }
}

/// One sample's part of the circle of confusion, and the pixel; never steeper than the cap.
TEST(Lens, AsksForWhatItsSamplesResolve) {
    Scene scene = half_plane(4);
    Settings& s = scene.settings;
    s.width = s.height = 512;
    for (double fov : {5.0, 60.0, 170.0})
        for (double aperture : {0.0, 1e-4, 0.1, 100.0})
            for (int samples : {1, 64}) {
                scene.camera.fov_degrees = fov;
                scene.camera.aperture_radius = aperture;
                s.samples = samples;
                const CameraField f = camera_field(scene.camera, s);
                EXPECT_LE(std::abs(f.slope) + f.growth, gradation_cap * (1 + 1e-12));
                EXPECT_NEAR(f.base + f.slope * 4, 0, 1e-12); // in focus
                EXPECT_LE(f.growth, s.edge_pixels * pixel_footprint(scene.camera, s));
                const double whole = std::sqrt(std::numbers::pi * aperture * aperture / samples);
                if (aperture < 1)
                    EXPECT_NEAR(std::abs(f.base + f.slope * 7), s.edge_pixels * whole * 3 / 4, 1e-12);
                else
                    EXPECT_NEAR(std::abs(f.slope), gradation_cap - f.growth, 1e-12);
            }
}

/// Where everything is out of focus little is diced.
TEST(Lens, WhatIsBlurredIsCoarse) {
    std::int64_t made[2];
    for (int k = 0; k < 2; ++k) {
        Scene scene = scene_of(cube_cage(), 200);
        scene.settings.lod = Lod::recursive;
        scene.settings.samples = 4;
        const double distance = glm::length(scene.camera.target - scene.camera.position);
        scene.camera.aperture_radius = 0.1 * distance;
        scene.camera.focus_distance = k == 0 ? distance : 0.3 * distance;
        Frame frame(scene, {});
        frame.render(*native_targets().back(), 0);
        made[k] = frame.statistics().counters.triangles_made;
    }
    EXPECT_LT(made[1] * 4, made[0]);
}

} // namespace
} // namespace razor::test
