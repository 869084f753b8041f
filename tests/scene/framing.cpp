// Framing of bare models: everything in the picture, light on it, and extremes that must not break it.
#include "razor/scene/framing.h"

#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/temporary_folder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace razor {
namespace {

/// A box's corners as an OBJ file.
std::string box(glm::dvec3 centre, glm::dvec3 half) {
    std::string text;
    for (int c = 0; c < 8; ++c) {
        text +=
            fmt::format("v {} {} {}\n", centre.x + half.x * ((c & 1) * 2 - 1),
                        centre.y + half.y * ((c >> 1 & 1) * 2 - 1), centre.z + half.z * ((c >> 2) * 2 - 1));
    }
    return text + "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";
}

/// Checks a framed scene and returns the greatest share of the half picture that a model's point reaches.
double check_framed(const Scene& scene) {
    const Camera& camera = scene.camera;
    const glm::dvec3 view = glm::normalize(camera.target - camera.position);
    const glm::dvec3 right = glm::normalize(glm::cross(view, camera.up));
    const glm::dvec3 up = glm::cross(right, view);
    const double half_height = std::tan(glm::radians(0.5 * camera.fov_degrees));
    const double half_width = half_height * scene.settings.width / scene.settings.height;
    EXPECT_GT(camera.position.y, camera.target.y);
    EXPECT_TRUE(std::isfinite(glm::length(camera.position)));
    double reach = 0;
    for (const glm::dvec3& p : scene.meshes[0].points) {
        const glm::dvec3 from_camera = p - camera.position;
        const double ahead = glm::dot(from_camera, view);
        EXPECT_GT(ahead, 0);
        reach = std::max({reach, std::abs(glm::dot(from_camera, right)) / ahead / half_width,
                          std::abs(glm::dot(from_camera, up)) / ahead / half_height});
    }
    EXPECT_LT(reach, 1);
    EXPECT_EQ(scene.lights.size(), 1U);
    const Light& light = scene.lights[0];
    const glm::dvec3 emits = glm::cross(light.edge_u, light.edge_v);
    EXPECT_GT(glm::length(emits), 0);
    const glm::dvec3 to_model = camera.target - (light.corner + 0.5 * light.edge_u + 0.5 * light.edge_v);
    EXPECT_GT(glm::dot(glm::normalize(emits), glm::normalize(to_model)), 0.99);
    EXPECT_LT(to_model.y, 0) << "the light should be above";
    return reach;
}

class Framing : public ::testing::Test {
protected:
    Scene framed(const std::string& obj, FramingOptions options = {}) const {
        return build_scene(frame_model(folder_.file("m.obj", obj), options));
    }
    TemporaryFolder folder_;
};

TEST_F(Framing, FillsThePictureOfAnyShape) {
    for (const glm::dvec3 half :
         {glm::dvec3(1), glm::dvec3(1, 9, 1), glm::dvec3(9, 1, 1), glm::dvec3(1, 1, 9)}) {
        for (const auto& [width, height] : {std::pair(512, 512), std::pair(1000, 200), std::pair(100, 900)}) {
            FramingOptions options;
            options.settings.width = width;
            options.settings.height = height;
            EXPECT_GT(check_framed(framed(box({5, -3, 2}, half), options)), 0.9);
        }
    }
}

TEST_F(Framing, SurvivesExtremes) {
    for (const double size : {1e-300, 1e-38, 1e-29, 1e-12, 1e-3, 1.0, 1e6, 1e12, 1e23}) {
        SCOPED_TRACE(size);
        const Scene scene = framed(box({0, 0, 0}, glm::dvec3(size)));
        const double reach = check_framed(scene);
        if (size > 1e-30) {
            EXPECT_GT(reach, 0.9);
        }
        EXPECT_EQ(scene.meshes[0].points[7], glm::dvec3(size)) << "in the model's own units";
    }
    for (const glm::dvec3 half : {glm::dvec3(1, 0, 1), glm::dvec3(1, 1, 0), glm::dvec3(0, 1, 1),
                                  glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 0)}) {
        for (const double at : {0.0, 1.0, 1e9}) {
            SCOPED_TRACE(fmt::format("({}, {}, {}) at {}", half.x, half.y, half.z, at));
            check_framed(framed(box(glm::dvec3(at), half)));
        }
    }
    EXPECT_THROW(framed(box({0, 0, 0}, glm::dvec3(1.1e24))), UserError);
    EXPECT_THROW(framed(box({1e300, 0, 0}, glm::dvec3(1))), UserError);
}

/// Whatever is placed about a model is within what scene files may say.
TEST_F(Framing, ExtremesCanBeWrittenAndRead) {
    FramingOptions options;
    options.settings.width = 1;
    options.settings.height = 32768;
    for (const double size : {1e-29, 1.0, 5e23}) {
        SCOPED_TRACE(size);
        const SceneDescription scene =
            frame_model(folder_.file("m.obj", box({0, 0, 0}, glm::dvec3(size))), options);
        const Scene expected = build_scene(scene);
        const Scene again = build_scene(parse_scene_file(to_toml(scene), "again.toml", folder_.path()));
        EXPECT_EQ(again.camera.position, expected.camera.position);
        ASSERT_EQ(again.meshes.size(), 2U);
        EXPECT_EQ(again.meshes[1].points, expected.meshes[1].points);
    }
}

TEST_F(Framing, TurnsZUpExactly) {
    FramingOptions options;
    options.up = Up::z;
    const Scene scene = framed("v 0.1 0.2 0.3\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", options);
    EXPECT_EQ(scene.meshes[0].points[0], glm::dvec3(0.1, 0.3, -0.2));
}

TEST_F(Framing, IgnoresPointsThatNoFaceUses) {
    const Scene scene = framed("v 1e5 0 0\n" + std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"));
    EXPECT_LT(glm::length(scene.camera.position), 20);
}

TEST_F(Framing, PutsAFloorUnderTheModel) {
    const Scene scene = framed(box({0, 7, 0}, glm::dvec3(1)));
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_LT(scene.meshes[1].points[0].y, 6);
    EXPECT_GT(scene.meshes[1].points[0].y, 5.9);
    EXPECT_EQ(scene.meshes[1].scheme, Scheme::bilinear);
    FramingOptions options;
    options.floor = false;
    EXPECT_EQ(framed(box({0, 7, 0}, glm::dvec3(1)), options).meshes.size(), 1U);
}

TEST(FramingOfRealModels, FillsThePicture) {
    const std::string folder = std::string(RAZOR_SHARED_SCENES);
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no shared scenes in " << folder;
    }
    for (const char* name :
         {"/spot/spot_control_mesh.obj", "/makehuman/female_generic.obj", "/osd/catmark_car.obj"}) {
        EXPECT_GT(check_framed(build_scene(frame_model(folder + name, {}))), 0.8) << name;
    }
}

} // namespace
} // namespace razor
