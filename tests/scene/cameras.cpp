// Cameras of both projections and the film's filter in scene files: read, printed, moved, and mistakes told.
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

const std::string mesh = "[[mesh]]\nshape = \"box\"\n";
const std::string orthographic = "[camera]\nprojection = \"orthographic\"\n";

SceneDescription read(const std::string& text) {
    return parse_scene_file(text + mesh, "s.toml", {});
}

void expect_printed_again(const SceneDescription& scene) {
    const std::string text = to_toml(scene);
    const SceneDescription again = parse_scene_file(text, "s.toml", {});
    EXPECT_EQ(to_toml(again), text);
    expect_same(build_scene(pose_at(again, 0.5)), build_scene(pose_at(scene, 0.5)));
}

TEST(Cameras, OrthographicOnesAreReadAndPrinted) {
    const SceneDescription scene =
        read(orthographic + "height = 12.5\nposition = [1, 2, 3]\n[dicing_camera]\n"
                            "projection = \"orthographic\"\nheight = 3\n");
    EXPECT_EQ(scene.camera.projection, Projection::orthographic);
    EXPECT_EQ(scene.camera.height, 12.5);
    EXPECT_FALSE(has_lens(scene.camera));
    EXPECT_EQ(scene.dicing_camera->height, 3);
    EXPECT_EQ(read("[camera]\nposition = [1, 2, 3]\n").camera.projection, Projection::perspective);
    expect_printed_again(scene);
}

TEST(Cameras, OrthographicOnesMove) {
    const SceneDescription scene = read(orthographic + "height = 2\n[[camera.key]]\ntime = 0\nheight = 2\n"
                                                       "[[camera.key]]\ntime = 1\nheight = 4\n");
    EXPECT_EQ(pose_at(scene, 0.5).camera.height, 3);
    EXPECT_EQ(pose_at(scene, 0.5).camera.projection, Projection::orthographic);
    expect_printed_again(scene);
}

TEST(Film, FiltersAreReadAndPrinted) {
    EXPECT_TRUE(is_pixel(read("").settings.filter));
    EXPECT_EQ(read("[film]\nfilter = \"lanczos\"\n").settings.filter, preset_filter(FilterKind::lanczos));
    const std::vector<std::pair<std::string, double Filter::*>> parameters{
        {"gaussian\"\nsigma = 0.75", &Filter::sigma},
        {"mitchell\"\nb = 0.75", &Filter::b},
        {"mitchell\"\nc = 0.75", &Filter::c},
        {"lanczos\"\ntau = 0.75", &Filter::tau}};
    for (const auto& [text, member] : parameters) {
        const SceneDescription scene = read("[film]\nradius = [1.25, 2]\nfilter = \"" + text + "\n");
        EXPECT_EQ(scene.settings.filter.radius, glm::dvec2(1.25, 2)) << text;
        EXPECT_EQ(scene.settings.filter.*member, 0.75) << text;
        expect_printed_again(scene);
    }
}

TEST(Cameras, MistakesAreTold) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[camera]\nprojection = \"ortographic\"\n",
         "s.toml:2:14: camera.projection 'ortographic' is unknown; did you mean 'orthographic'?"},
        {orthographic, "s.toml:1:1: an orthographic camera needs a height"},
        {orthographic + "height = 0\n", "camera.height = 0 is out of range"},
        {orthographic + "height = 1\nfov = 30\n", "s.toml:4:7: camera.fov is of a perspective camera"},
        {orthographic + "height = 1\naperture_radius = 0.1\n",
         "s.toml:4:19: camera.aperture_radius is of a perspective camera"},
        {"[camera]\nheight = 3\n", "s.toml:2:10: camera.height is of a camera with projection"},
        {"[dicing_camera]\nheight = 3\n", "dicing_camera.height is of a camera with"},
        {orthographic + "height = 1\n[[camera.key]]\ntime = 0\nfov = 30\n", "unknown key 'camera.key.fov'"},
        {"[camera]\n[[camera.key]]\ntime = 0\nheight = 30\n", "unknown key 'camera.key.height'"},
        {"[film]\nfilter = \"gauss\"\n", "s.toml:2:10: film.filter 'gauss' is unknown"},
        {"[film]\nradius = 2\n", "film.radius is a whole number; write two numbers"},
        {"[film]\nradius = [0, 2]\n", "film.radius = 0 is out of range"},
        {"[film]\nsigma = 2\n", "unknown key 'film.sigma'"},
    };
    for (const auto& [text, expected] : cases) {
        try {
            read(text);
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(expected), std::string::npos) << text << " says: " << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

} // namespace
} // namespace razor
