// Lights in scene files: every kind is read, printed and moved, and mistakes are told.
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/same_scene.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace razor {
namespace {

const std::string mesh = "[[mesh]]\nshape = \"box\"\n[camera]\n";

constexpr const char* all_kinds = R"(
    [[light]]
    kind = "rectangle"
    edge_u = [2, 0, 0]
    [[light]]
    kind = "disk"
    position = [1, 2, 3]
    direction = [0, -2, 1]
    radius = 0.25
    radiance = 4
    [[light]]
    kind = "sphere"
    position = [4, 2, 3]
    radius = 3
    radiance = [1, 2, 3]
    [[light]]
    kind = "point"
    position = [5, 2, 3]
    intensity = 7
    [[light]]
    kind = "spot"
    position = [6, 2, 3]
    direction = [1, 0, 0]
    cone_angle = 20
    cone_delta = 2
    intensity = [7, 8, 9]
    [[light]]
    kind = "directional"
    direction = [1, -1, 0]
    angular_radius = 0.267
    irradiance = 3
)";

TEST(SceneLights, EveryKindIsReadAndPrinted) {
    const SceneDescription scene = parse_scene_file(mesh + all_kinds, "s.toml", {});
    ASSERT_EQ(scene.lights.size(), 6U);
    for (int i = 0; i < 6; ++i)
        EXPECT_EQ(static_cast<int>(scene.lights[static_cast<std::size_t>(i)].kind), i);
    EXPECT_EQ(scene.lights[0].edge_u, glm::dvec3(2, 0, 0));
    EXPECT_EQ(scene.lights[1].radius, 0.25);
    EXPECT_EQ(scene.lights[1].direction, glm::dvec3(0, -2, 1));
    EXPECT_EQ(scene.lights[2].radiance, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[3].position, glm::dvec3(5, 2, 3));
    EXPECT_EQ(scene.lights[3].radiance, glm::vec3(7));
    EXPECT_EQ(scene.lights[4].cone_angle, 20);
    EXPECT_EQ(scene.lights[4].cone_delta, 2);
    EXPECT_EQ(scene.lights[5].angular_radius, 0.267);
    EXPECT_EQ(scene.lights[5].radiance, glm::vec3(3));
    const std::string text = to_toml(scene);
    const SceneDescription again = parse_scene_file(text, "t.toml", {});
    expect_same(build_scene(scene), build_scene(again));
    EXPECT_EQ(to_toml(again), text);
}

TEST(SceneLights, MoveByTheKeysOfTheirKind) {
    const SceneDescription scene = parse_scene_file(mesh + R"(
        [[light]]
        kind = "spot"
        direction = [1, 0, 0]
        [[light.key]]
        time = 0
        position = [0, 0, 0]
        cone_angle = 10
        intensity = 1
        [[light.key]]
        time = 2
        position = [4, 0, 0]
        cone_angle = 30
        intensity = 3
    )",
                                                    "s.toml", {});
    EXPECT_TRUE(is_animated(scene));
    const Light light = pose_at(scene, 1).lights[0];
    EXPECT_EQ(light.position, glm::dvec3(2, 0, 0));
    EXPECT_EQ(light.cone_angle, 20);
    EXPECT_EQ(light.radiance, glm::vec3(2));
    EXPECT_EQ(light.direction, glm::dvec3(1, 0, 0)) << "has no keys";
    const SceneDescription again = parse_scene_file(to_toml(scene), "t.toml", {});
    expect_same(build_scene(pose_at(again, 0.5)), build_scene(pose_at(scene, 0.5)));
}

TEST(SceneLights, MistakesNameThePlaceAndTheMend) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"kind = \"lamp\"", "light.kind"},
        {"kind = \"point\"\nradius = 1", "unknown key 'light.radius'"},
        {"kind = \"point\"\nradiance = 1", "unknown key 'light.radiance'"},
        {"corner = [0, 0, 0]\nposition = [0, 0, 0]", "unknown key 'light.position'"},
        {"kind = \"sphere\"\nradius = 0", "light.radius is 0"},
        {"kind = \"sphere\"\nradius = -1", "light.radius"},
        {"kind = \"disk\"\ndirection = [0, 0, 0]", "light.direction is zero"},
        {"kind = \"spot\"\ncone_angle = 0\ncone_delta = 0", "light.cone_angle is 0"},
        {"kind = \"spot\"\ncone_angle = 3", "light.cone_delta exceeds light.cone_angle"},
        {"kind = \"spot\"\ncone_angle = 181", "light.cone_angle"},
        {"kind = \"directional\"\nangular_radius = 90", "light.angular_radius"},
        {"kind = \"directional\"\nirradiance = nan", "light.irradiance"},
        {"kind = \"point\"\n[[light.key]]\ntime = 1\ncorner = [0, 0, 0]", "corner"},
    };
    for (const auto& [text, message] : cases) {
        try {
            parse_scene_file(mesh + "[[light]]\n" + text + "\n", "s.toml", {});
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
            EXPECT_TRUE(std::string(error.what()).starts_with("s.toml:")) << error.what();
        }
    }
}

} // namespace
} // namespace razor
