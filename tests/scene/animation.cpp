// What moves: tracks beside closed forms, poses, printing and reading, mistakes.
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/same_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor {
namespace {

constexpr Timing linear{Interpolation::linear, 0}, step{Interpolation::step, 0},
    smooth{Interpolation::smooth, 0};

TEST(Track, FollowsItsKeys) {
    const Track<double> track{{{1, 10}, {2, 20}, {4, 0}}};
    for (const Timing& timing : {linear, step, smooth}) {
        EXPECT_EQ(track.at(-5, timing), 10) << "the first holds";
        EXPECT_EQ(track.at(1, timing), 10);
        EXPECT_EQ(track.at(2, timing), 20);
        EXPECT_EQ(track.at(4, timing), 0);
        EXPECT_EQ(track.at(9, timing), 0) << "the last holds";
    }
    EXPECT_EQ(track.at(1.25, linear), 12.5);
    EXPECT_EQ(track.at(3, linear), 10);
    EXPECT_EQ(track.at(1.99, step), 10);
    EXPECT_EQ(track.at(3.99, step), 20);
    // Slopes 10, -10/3, -10: Hermite cubics in the middle of each span.
    EXPECT_NEAR(track.at(1.5, smooth), 15 + (10 - -10.0 / 3) / 8, 1e-13);
    EXPECT_NEAR(track.at(3, smooth), 10 + 2 * (-10.0 / 3 - -10) / 8, 1e-13);
}

// A cubic through even keys keeps its shape where both neighbours are there; a line everywhere.
TEST(Track, SmoothKeepsLinesAndParabolas) {
    Track<double> line, parabola;
    for (const double t : {0.0, 1.0, 3.0, 3.5, 7.0})
        line.keys.push_back({t, 5 - 2 * t});
    for (int t = 0; t < 6; ++t)
        parabola.keys.push_back({double(t), 1.0 + t * t});
    for (double t = 0; t <= 7; t += 0.125)
        EXPECT_NEAR(line.at(t, smooth), 5 - 2 * t, 1e-13);
    for (double t = 1; t <= 4; t += 0.125)
        EXPECT_NEAR(parabola.at(t, smooth), 1 + t * t, 1e-13);
}

TEST(Track, ACycleHasNoSeam) {
    const Track<double> track{{{0.5, 1}, {1, 4}, {1.75, -2}}};
    for (const Interpolation how : {Interpolation::step, Interpolation::linear, Interpolation::smooth}) {
        const Timing cycle{how, 2};
        for (double t = 0; t < 2; t += 0.0625)
            for (const int turns : {-2, -1, 1, 5})
                EXPECT_EQ(track.at(t, cycle), track.at(t + 2 * turns, cycle)) << t;
        EXPECT_EQ(track.at(2.5, cycle), 1);
        EXPECT_EQ(track.at(3.75, cycle), -2);
        if (how == Interpolation::step)
            continue;
        constexpr double small = 1e-6;
        const auto slope = [&](double t) {
            return (track.at(t + small, cycle) - track.at(t - small, cycle)) / (2 * small);
        };
        for (const double t : {0.0, 0.5, 1.0, 1.75, 2.0}) {
            EXPECT_NEAR(track.at(t - small, cycle), track.at(t + small, cycle), 1e-4) << t;
            if (how == Interpolation::smooth) {
                EXPECT_NEAR(slope(t - 2 * small), slope(t + 2 * small), 1e-3) << t;
            }
        }
    }
    // From the last key on to the first one of the next turn, 0.75 s later.
    EXPECT_EQ(track.at(2.125, {Interpolation::linear, 2}), -0.5);
    const Track<double> turn{{{0, 0}, {2, 360}}};
    EXPECT_EQ(turn.at(1.5, {Interpolation::linear, 2}), 270);
    EXPECT_EQ(turn.at(2, {Interpolation::linear, 2}), 0);
    const Track<double> one{{{0, 7}}};
    EXPECT_EQ(one.at(0.3, {Interpolation::smooth, 1}), 7);
}

constexpr std::string_view moving = R"(
    [animation]
    rate = 8
    [camera]
    position = [0, 0, 9]
    interpolation = "smooth"
    [[camera.key]]
    time = 0
    position = [0, 0, 9]
    fov = 40
    [[camera.key]]
    time = 1
    position = [2, 0, 9]
    target = [0, 1, 0]
    up = [0, 1, 0.5]
    fov = 60
    aperture_radius = 0.25
    focus_distance = 3
    [[light]]
    corner = [0, 5, 0]
    cycle = 4
    [[light.key]]
    time = 1
    corner = [1, 5, 0]
    edge_u = [1, 0, 0]
    edge_v = [0, 0, 1]
    radiance = 2
    [[light.key]]
    time = 3
    corner = [3, 5, 0]
    radiance = [4, 2, 0]
    [[light]]
    corner = [0, 9, 0]
    [[light.key]]
    time = 0
    corner = [0, 9, 0]
    [[light.key]]
    time = 2
    corner = [0, 1, 0]
    [[mesh]]
    name = "a"
    shape = "box"
    [[group]]
    name = "g"
    [[group.object]]
    mesh = "a"
    [[group.object.key]]
    time = 0.5
    scale = 2
    [[group.object.key]]
    time = 1.5
    scale = [4, 2, 2]
    rotate = [0, 90, 0]
    [[object]]
    group = "g"
    translate = [0, 7, 0]
    rotate = [10, 0, 0]
    interpolation = "step"
    [[object.key]]
    time = 0
    translate = [1, 0, 0]
    [[object.key]]
    time = 2
    translate = [2, 0, 0]
    [[object]]
    mesh = "a"
)";

TEST(Pose, PutsEverythingWhereItsKeysSay) {
    const SceneDescription scene = parse_scene_file(moving, "s.toml", {});
    EXPECT_TRUE(is_animated(scene));
    EXPECT_EQ(scene.frame_rate, 8);
    const SceneDescription at = pose_of_frame(scene, 8); // a second
    EXPECT_FALSE(is_animated(at));
    EXPECT_EQ(at.objects[0].transform.translate, glm::dvec3(1, 0, 0));
    EXPECT_EQ(at.objects[0].transform.rotate, glm::dvec3(10, 0, 0)) << "has no keys";
    EXPECT_EQ(at.groups[0].objects[0].transform.scale, glm::dvec3(3, 2, 2));
    EXPECT_EQ(at.groups[0].objects[0].transform.rotate, glm::dvec3(0, 90, 0));
    EXPECT_EQ(at.camera.position, glm::dvec3(2, 0, 9));
    EXPECT_EQ(at.camera.target, glm::dvec3(0, 1, 0));
    EXPECT_EQ(at.camera.up, glm::dvec3(0, 1, 0.5));
    EXPECT_EQ(at.camera.fov_degrees, 60);
    EXPECT_EQ(at.camera.aperture_radius, 0.25);
    EXPECT_EQ(at.camera.focus_distance, 3);
    EXPECT_EQ(at.lights[0].corner, glm::dvec3(1, 5, 0));
    EXPECT_EQ(at.lights[0].radiance, glm::vec3(2));
    EXPECT_EQ(pose_of_frame(scene, 16).objects[0].transform.translate, glm::dvec3(2, 0, 0));
    EXPECT_EQ(pose_of_frame(scene, 16).lights[0].radiance, glm::vec3(3, 2, 1));
    ASSERT_EQ(at.lights.size(), 2U);
    EXPECT_EQ(at.lights[1].corner, glm::dvec3(0, 5, 0)) << "moves by its own keys";
    EXPECT_EQ(pose_of_frame(scene, 32).lights[0].corner, glm::dvec3(2, 5, 0)) << "half-way back";
    EXPECT_EQ(pose_of_frame(scene, 4).camera.position, glm::dvec3(1, 0, 9));
    EXPECT_FALSE(is_animated(parse_scene_file("[[mesh]]\nshape = \"box\"\n", "s.toml", {})));
}

TEST(Pose, PrintedConfigurationMovesAlike) {
    const SceneDescription scene = parse_scene_file(moving, "s.toml", {});
    const std::string printed = to_toml(scene);
    const SceneDescription again = parse_scene_file(printed, "t.toml", {});
    EXPECT_EQ(to_toml(again), printed);
    EXPECT_EQ(again.camera_keys, scene.camera_keys);
    EXPECT_EQ(again.light_keys, scene.light_keys);
    EXPECT_EQ(again.objects[0].keys, scene.objects[0].keys);
    EXPECT_EQ(again.groups[0].objects[0].keys, scene.groups[0].objects[0].keys);
    for (const int frame : {0, 3, 11}) { // a pose is a scene by itself
        const std::string pose = to_toml(pose_of_frame(scene, frame));
        EXPECT_EQ(to_toml(pose_of_frame(parse_scene_file(pose, "u.toml", {}), 5)), pose);
        expect_same(build_scene(pose_of_frame(again, frame)).camera,
                    build_scene(pose_of_frame(scene, frame)).camera);
    }
}

std::string message_of(const std::string& text, double seconds = -1) {
    try {
        const SceneDescription scene = parse_scene_file(text, "s.toml", {});
        if (seconds >= 0)
            pose_at(scene, seconds);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

TEST(Pose, MistakesAreNamed) {
    const std::string mesh = "[[mesh]]\nname = \"a\"\nshape = \"box\"\n",
                      object = mesh + "[[object]]\nmesh = \"a\"\n";
    const std::pair<std::string, std::string> cases[] = {
        {object + "[[object.key]]\ntranslate = [0, 0, 0]\n", "s.toml:6:1: a key without a time"},
        {object + "[[object.key]]\ntime = 1\n", "s.toml:7:8: a key that says nothing but its time"},
        {object + "[[object.key]]\ntime = 1\nscale = 2\n[[object.key]]\ntime = 1\nscale = 2\n",
         "s.toml:10:8: a key at 1 s after one at 1 s"},
        {object + "cycle = 2\n[[object.key]]\ntime = 3\nscale = 2\n", "a key at 3 s of a cycle of 2 s"},
        {object + "[[object.key]]\ntime = 1\nfov = 2\n", "fov"},
        {object + "[[object.key]]\ntime = -1\nscale = 2\n", "time"},
        {object + "interpolation = \"cubic\"\n[[object.key]]\ntime = 1\nscale = 2\n", "step, linear, smooth"},
        {object + "cycle = 2\n", "s.toml:6:9: cycle without keys"},
        {object + "interpolation = \"step\"\n", "interpolation without keys"},
        {object +
             "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n[[object.key]]\ntime = 1\nscale = 2\n",
         "a matrix and keys"},
        {mesh + "[animation]\nrate = 0\n", "rate"},
        {mesh + "[dicing_camera]\nfov = 30\n[[dicing_camera.key]]\ntime = 0\nfov = 20\n", "key"},
    };
    for (const auto& [text, cause] : cases)
        EXPECT_NE(message_of(text).find(cause), std::string::npos) << message_of(text) << "\n" << text;
    const std::string camera =
        mesh + "[camera]\nposition = [0, 0, 4]\n[[camera.key]]\ntime = 0\nposition = [0, 0, 4]\n"
               "[[camera.key]]\ntime = 2\nposition = [0, 0, -4]\n";
    EXPECT_EQ(message_of(camera, 0.5), "");
    EXPECT_EQ(message_of(camera, 1),
              "s: 1 s after the beginning camera.position equals camera.target; move one of them");
    const std::string light = "[[light]]\nedge_u = [0, 0, 1]\nedge_v = [1, 0, 0]\n",
                      turns = light + "[[light.key]]\ntime = 0\nedge_u = [0, 0, 1]\n[[light.key]]\ntime = "
                                      "1\nedge_u = [1, 0, 0]\n";
    EXPECT_EQ(message_of(turns + mesh, 1).find("s: 1 s after the beginning light.edge_u and"), 0U);
    EXPECT_EQ(message_of(light + turns + mesh, 1)
                  .find("s: 1 s after the beginning of light 2 of 2: light.edge_u and"),
              0U);
}

} // namespace
} // namespace razor
