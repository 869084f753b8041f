// Scene files: every key, every kind of mistake, and the printed configuration that loads again.
#include "razor/scene/scene_file.h"

#include "razor/scene/default_scene.h"
#include "razor/scene/error.h"
#include "razor/scene/framing.h"
#include "razor/scene/nearest.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace razor {
namespace {

constexpr std::string_view triangle = "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";

std::string message_of(std::string_view text, const std::filesystem::path& folder = {}) {
    try {
        parse_scene_file(text, "s.toml", folder);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

TEST(Nearest, IsLeastEdits) {
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("szie", "size"), 1);
    EXPECT_EQ(edit_distance("size", "size"), 0);
}

// What was meant is asked only where that may be: of a word that is like no other, no one is told.
TEST(Nearest, IsMeantWhereNear) {
    constexpr std::array<std::string_view, 12> words{"radiance", "corner",   "edge_v",        "edge_u",
                                                     "lod",      "rotation", "fov",           "size",
                                                     "--size",   "m",        "l2.size_bytes", "kd"};
    const std::pair<std::string_view, std::string_view> meant_by[] = {
        {"radience", "radiance"},
        {"edge", "edge_v"},
        {"edge_U", "edge_v"},
        {"rotate", "rotation"},
        {"fow", "fov"},
        {"szie", "size"},
        {"--sise", "--size"},
        {"kdd", "kd"},
        {"l2.size", "l2.size_bytes"},
        {"rad", "radiance"},
        {"corners", "corner"},
        // What has as many other letters as like ones is another word.
        {"side", "size"},
        {"time", ""},
        {"noise", ""},
        {"n", ""},
        {"--frobnicate", ""},
        {"kind", ""},
        {"", ""},
        {"-", ""},
        {"samples", ""},
        {"l2.way", ""},
        {"ra", ""}};
    for (const auto& [word, other] : meant_by)
        EXPECT_EQ(meant(word, words), other) << word;
    constexpr std::array<std::string_view, 2> few{"size", "crop"};
    EXPECT_EQ(or_known("sise", few), "did you mean 'size'? Known: size, crop");
    EXPECT_EQ(or_known("spp", few, "There are"), "there are: size, crop");
}

// Of what a number, three of them, or either, may be.
TEST(SceneFile, WrongTypesSayWhatIsWanted) {
    const std::string mesh = "[[mesh]]\nshape = \"box\"\n",
                      numbers = "write a number from 1e-30 to 1e+30, or three of them [a, b, c]";
    const std::pair<std::string, std::string> wrong[] = {
        {mesh + "scale = \"2\"", "s.toml:3:9: mesh.scale is text; " + numbers},
        {mesh + "scale = [1, 2]", "s.toml:3:9: mesh.scale is an array of 2; " + numbers},
        {mesh + "scale = true", "s.toml:3:9: mesh.scale is true or false; " + numbers},
        {mesh + "scale = [1, \"2\", 3]",
         "s.toml:3:13: mesh.scale is text; write a number from 1e-30 to 1e+30"},
        {mesh + "translate = \"2\"", "s.toml:3:13: mesh.translate is text; write three numbers [a, b, c]"},
        {mesh + "edge_length = \"2\"", "s.toml:3:15: mesh.edge_length is text; write a number from "},
        {"[settings]\nsamples = \"2\"\n" + mesh,
         "s.toml:2:11: settings.samples is text; write a whole number from 1 to 65536"},
        {"[sky]\nradiance = \"2\"\n" + mesh, "s.toml:2:12: sky.radiance is text; write a number from 0 to "
                                             "1000000000, or three of them [a, b, c]"},
    };
    for (const auto& [text, says] : wrong)
        EXPECT_TRUE(message_of(text).starts_with(says)) << message_of(text);
}

TEST(SceneFile, ReadsEveryKey) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    const Scene scene = build_scene(parse_scene_file(R"(
        name = "n"
        [settings]
        size = [640, 480]
        crop = [600, 479, 40, 1]
        samples = 9
        light_samples = 2
        light_choices = 7
        sky_samples = 3
        noise_threshold = 0.02
        seed = 11
        edge_pixels = 0.5
        lod = "recursive"
        [camera]
        position = [1, 2, 3]
        target = [4, 5, 6.5]
        up = [0, 0, 1]
        fov = 50
        aperture_radius = 0.125
        focus_distance = 7
        [dicing_camera]
        position = [9, 2, 3]
        [sky]
        radiance = 0.5
        [[light]]
        corner = [0, 9, 0]
        edge_u = [2, 0, 0]
        edge_v = [0, 0, 3]
        radiance = [1, 2, 3]
        [[material]]
        name = "red"
        albedo = [0.9, 0.1, 0.1]
        [[material]]
        name = "grey"
        albedo = 0.25
        [[mesh]]
        name = "first"
        file = "tri.obj"
        scheme = "bilinear"
        material = "grey"
        scale = [2, 3, 4]
        rotate = [0, 90, 90]
        translate = [10, 0, 0]
        edge_length = 0.125
        [[mesh]]
        shape = "box"
        parameters = { width = 4 })",
                                                     "s.toml", folder.path()));
    EXPECT_EQ(scene.name, "n");
    EXPECT_EQ(scene.settings.width, 640);
    EXPECT_EQ(scene.settings.height, 480);
    EXPECT_EQ(scene.settings.crop, (Crop{600, 479, 40, 1}));
    EXPECT_EQ(scene.settings.samples, 9);
    EXPECT_EQ(scene.settings.light_samples, 2);
    EXPECT_EQ(scene.settings.light_choices, 7);
    EXPECT_EQ(scene.settings.sky_samples, 3);
    EXPECT_EQ(scene.settings.noise_threshold, 0.02);
    EXPECT_EQ(scene.settings.seed, 11);
    EXPECT_EQ(scene.settings.edge_pixels, 0.5);
    EXPECT_EQ(scene.settings.lod, Lod::recursive);
    EXPECT_EQ(scene.camera.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.camera.target, glm::dvec3(4, 5, 6.5));
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(scene.camera.fov_degrees, 50);
    EXPECT_EQ(scene.camera.aperture_radius, 0.125);
    EXPECT_EQ(scene.camera.focus_distance, 7);
    ASSERT_TRUE(scene.dicing_camera.has_value());
    EXPECT_EQ(scene.dicing_camera->position, glm::dvec3(9, 2, 3));
    EXPECT_EQ(scene.dicing_camera->fov_degrees, Camera{}.fov_degrees);
    EXPECT_EQ(scene.sky, glm::vec3(0.5F));
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.lights[0].corner, glm::dvec3(0, 9, 0));
    EXPECT_EQ(scene.lights[0].edge_u, glm::dvec3(2, 0, 0));
    EXPECT_EQ(scene.lights[0].edge_v, glm::dvec3(0, 0, 3));
    EXPECT_EQ(scene.lights[0].radiance, glm::vec3(1, 2, 3));
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].albedo, glm::vec3(0.25F));
    ASSERT_EQ(scene.meshes.size(), 2U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.name, "first");
    EXPECT_EQ(mesh.scheme, Scheme::bilinear);
    EXPECT_EQ(mesh.material, 1);
    EXPECT_EQ(mesh.edge_length, 0.125);
    // scale, then y: (x,y,z) -> (z,y,-x), then z: (x,y,z) -> (-y,x,z), then translate
    EXPECT_EQ(mesh.points[0], glm::dvec3(10, 0, -2));
    EXPECT_EQ(mesh.points[1], glm::dvec3(7, 0, 0));
    EXPECT_EQ(mesh.points[2], glm::dvec3(10, 4, 0));
    EXPECT_EQ(scene.meshes[1].name, "box");
    EXPECT_EQ(scene.meshes[1].material, 0);
    EXPECT_EQ(scene.meshes[1].scheme, Scheme::catmull_clark);
    EXPECT_EQ(scene.meshes[1].points[7], glm::dvec3(2, 1, 1));
}

TEST(SceneFile, TransformsInDoublePrecision) {
    const Scene scene =
        build_scene(parse_scene_file("[[mesh]]\nshape = \"box\"\ntranslate = [1e12, 0, 0]\nscale = 0.125\n"
                                     "rotate = [0, 30, 0]\n",
                                     "s.toml", {}));
    EXPECT_NEAR(scene.meshes[0].points[7].x - 1e12, 0.125 * (std::sqrt(0.75) + 0.5), 1e-4);
    EXPECT_NEAR(scene.meshes[0].points[7].z, 0.125 * (std::sqrt(0.75) - 0.5), 1e-15);
}

TEST(SceneFile, PrintedConfigurationLoadsAgain) {
    const TemporaryFolder folder;
    const std::filesystem::path model = folder.file("tri \"x\" \\ y.obj", triangle);
    const SceneDescription framed =
        frame_model(model, {.up = Up::z, .floor = true, .scheme = {}, .settings = {}});
    SceneDescription cropped = framed;
    cropped.settings.crop = {3, 5, 7, 11};
    for (const SceneDescription& description : {default_scene(), framed, cropped}) {
        const std::string text = to_toml(description);
        const SceneDescription again = parse_scene_file(text, "elsewhere/s.toml", "/nowhere");
        expect_same(build_scene(description), build_scene(again));
        EXPECT_EQ(to_toml(again), text);
    }
}

TEST(SceneFile, BuiltInSceneIsTheDefaultFile) {
    const std::filesystem::path file =
        std::filesystem::path(RAZOR_SOURCE_DIR) / "configs/scenes/default.toml";
    const Scene scene = load_scene(file);
    expect_same(build_scene(default_scene()), scene);
    EXPECT_GE(scene.meshes.size(), 8U);
    EXPECT_EQ(scene.lights.size(), 1U);
}

TEST(SceneFile, PlacesCameraAndLightWhereNoneIsStated) {
    const Scene bare =
        build_scene(parse_scene_file("[[mesh]]\nshape = \"box\"\ntranslate = [100, 0, 0]\n", "s.toml", {}));
    EXPECT_EQ(bare.lights.size(), 1U);
    EXPECT_GT(bare.sky.y, 0);
    EXPECT_NEAR(bare.camera.target.x, 100, 1e-9);
    const Scene dark = build_scene(
        parse_scene_file("[sky]\nradiance = 0\n[camera]\n[[mesh]]\nshape = \"box\"\n", "s.toml", {}));
    EXPECT_TRUE(dark.lights.empty());
    EXPECT_EQ(dark.sky, glm::vec3(0));
    EXPECT_EQ(dark.camera.position, Camera{}.position);
}

TEST(SceneFile, LoadsByExtension) {
    const TemporaryFolder folder;
    EXPECT_EQ(load_scene(folder.file("t.obj", triangle)).meshes[0].points.size(), 3U);
    EXPECT_EQ(load_scene(folder.file("t.OBJ", triangle)).meshes[0].points.size(), 3U);
    EXPECT_EQ(load_scene(folder.file("t.toml", "[[mesh]]\nfile = \"t.obj\"\n")).meshes[0].name, "t");
    EXPECT_THROW(load_scene(folder.file("t.ply", triangle)), UserError);
    EXPECT_THROW(load_scene(folder.file("t", triangle)), UserError);
}

TEST(SceneFile, MistakesNamePlaceCauseAndMend) {
    const TemporaryFolder folder;
    folder.file("bad.obj", "v 1\n");
    const std::string mesh = "[[mesh]]\nshape = \"box\"\n";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[settings]\nsamlpes = 4\n" + mesh,
         "s.toml:2:1: unknown key 'settings.samlpes'; did you mean 'samples'? Known: size"},
        {"zeta = 1\nalpha = 2\n" + mesh, "s.toml:1:1: unknown key 'zeta'"},
        {"alpha = 2\nzeta = 1\n" + mesh, "s.toml:1:1: unknown key 'alpha'"},
        {"[setings]\n" + mesh, "s.toml:1:2: unknown key 'setings'; did you mean 'settings'?"},
        {mesh + "sceme = 1\n", "s.toml:3:1: unknown key 'mesh.sceme'; did you mean 'scheme'?"},
        {mesh + "[mesh.parameters]\nwith = 1\n", "unknown key 'mesh.parameters.with'; did you mean 'width'?"},
        {"[sky]\nradience = 1\n" + mesh, "did you mean 'radiance'?"},
        {"[camera]\nfow = 1\n" + mesh, "did you mean 'fov'?"},
        {"[[light]]\nedge_w = [1,2,3]\n" + mesh,
         "s.toml:2:1: unknown key 'light.edge_w'; did you mean 'edge_u'?"},
        {"[[material]]\nname = \"a\"\ncolour = 1\n" + mesh, "unknown key 'material.colour'"},
        {"[settings]\nsamples = \"4\"\n" + mesh,
         "s.toml:2:11: settings.samples is text; write a whole number from 1 to 65536"},
        {"[settings]\nsamples = 4.5\n" + mesh, "settings.samples is a number; write a whole number"},
        {"[settings]\nsamples = 0\n" + mesh,
         "settings.samples = 0 is out of range; write a number from 1 to 65536"},
        {"[settings]\nsamples = 99999999999999\n" + mesh, "out of range"},
        {"[settings]\nsize = 512\n" + mesh, "settings.size is a whole number; write two whole numbers"},
        {"[settings]\nsize = [512]\n" + mesh, "settings.size is an array of 1"},
        {"[settings]\nsize = [512, -1]\n" + mesh, "settings.size = -1 is out of range"},
        {"[settings]\nsize = [512, true]\n" + mesh, "settings.size is true or false"},
        {"[settings]\ncrop = [0, 0, 9]\n" + mesh,
         "s.toml:2:8: settings.crop is an array of 3; write four whole numbers [a, b, c, d]"},
        {"[settings]\ncrop = [0, 0, 0, 0]\n" + mesh, "the crop of 0 x 0 pixels at (0, 0) is not a part"},
        {"[settings]\ncrop = [-1, 0, 9, 9]\n" + mesh, "settings.crop = -1 is out of range"},
        {"[settings]\nsize = [64, 32]\ncrop = [32, 30, 32, 3]\n" + mesh,
         "s.toml:3:8: the crop of 32 x 3 pixels at (32, 30) is not a part of a picture of 64 x 32; give"},
        {"[settings]\ncrop = [5, 5, 0, 1]\n" + mesh, "the crop of 0 x 1 pixels at (5, 5) is not"},
        {"[settings]\nlod = \"coarse\"\n" + mesh, "settings.lod 'coarse' is unknown; known: "},
        {"[settings]\nedge_pixels = nan\n" + mesh, "settings.edge_pixels = nan is out of range"},
        {"settings = 3\n" + mesh, "s.toml:1:12: settings is a whole number; write a table [settings]"},
        {"light = 3\n" + mesh, "light is a whole number; write [[light]]"},
        {"light = [3]\n" + mesh, "light holds a whole number; write [[light]]"},
        {"name = 3\n" + mesh, "name is a whole number; write text in quotes"},
        {"[camera]\nposition = [1, 2]\n" + mesh, "camera.position is an array of 2; write three numbers"},
        {"[camera]\nposition = [1, 2, inf]\n" + mesh, "out of range"},
        {"[camera]\nfov = 180\n" + mesh,
         "camera.fov = 180 is out of range; write a number from 0.001 to 179"},
        {"[camera]\naperture_radios = 1\n" + mesh,
         "unknown key 'camera.aperture_radios'; did you mean 'aperture_radius'?"},
        {"[camera]\naperture_radius = -0.5\n" + mesh,
         "s.toml:2:19: camera.aperture_radius = -0.5 is out of range"},
        {"[camera]\nfocus_distance = -1\n" + mesh, "camera.focus_distance = -1 is out of range"},
        {"[camera]\nfocus_distance = \"far\"\n" + mesh, "camera.focus_distance is text; write a number"},
        {"[dicing_camera]\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n" + mesh,
         "s.toml:2:12: dicing_camera.position equals dicing_camera.target"},
        {"[dicing_camera]\nfow = 1\n" + mesh, "unknown key 'dicing_camera.fow'; did you mean 'fov'?"},
        {"[camera]\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n" + mesh,
         "s.toml:2:12: camera.position equals camera.target"},
        {"[camera]\nup = [0, 0, 0]\n" + mesh, "camera.up is zero or along the line of sight"},
        {"[camera]\nposition = [0, 5, 0]\n" + mesh,
         "s.toml:1:1: camera.up is zero or along the line of sight"},
        {"[[light]]\nedge_u = [0, 0, 2]\nedge_v = [0, 0, 1]\n" + mesh, "span no rectangle"},
        {"[[light]]\nedge_u = [1, 0, 1]\nedge_v = [0, 0, 1]\n" + mesh, "not at right angles"},
        {"[[light]]\n[[light]]\nedge_u = [0, 0, 1]\n" + mesh,
         "s.toml:3:10: light.edge_u and light.edge_v span"},
        {"[[light]]\nradiance = -1\n" + mesh, "out of range"},
        {"[[material]]\nalbedo = 1\n" + mesh, "a material without a name"},
        {"[[material]]\nname = \"a\"\nalbedo = 1.5\n" + mesh,
         "material.albedo = 1.5 is out of range; write a number from 0 to 1"},
        {"[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n" + mesh,
         "s.toml:4:8: the name 'a' is used twice"},
        {"name = \"x\"\n", "no meshes; write at least one [[mesh]]"},
        {"[[mesh]]\n", "s.toml:1:1: a mesh needs either file"},
        {mesh + "file = \"x.obj\"\n", "a mesh needs either file"},
        {"[[mesh]]\nshape = \"bux\"\n", "s.toml:2:9: mesh.shape 'bux' is unknown; did you mean 'box'?"},
        {mesh + "scheme = \"catmul\"\n",
         "mesh.scheme 'catmul' is unknown; did you mean 'catmark'? Known: catmark, bilinear"},
        {mesh + "scheme = 1\n", "mesh.scheme is a whole number; write one of: catmark, bilinear"},
        {"[[material]]\nname = \"sand\"\n" + mesh + "material = \"snad\"\n", "did you mean 'sand'?"},
        {mesh + "scale = 0\n", "mesh.scale = 0 is out of range"},
        {mesh + "scale = [1, -1, 1]\n", "mesh.scale = -1 is out of range"},
        {mesh + "rotate = 90\n", "mesh.rotate is a whole number; write three numbers"},
        {mesh + "parameters = { sharpness = 11 }\n",
         "mesh.parameters.sharpness = 11 is out of range; write a number from 0 to 10"},
        {"[[mesh]]\nshape = \"gear\"\nparameters = { teeth = 9.5 }\n",
         "mesh.parameters.teeth is a number; write a whole number"},
        {"[[mesh]]\nfile = \"none.obj\"\n", "s.toml:2:8: "},
        {"[[mesh]]\nfile = \"none.obj\"\n", "none.obj: no such file"},
        {"[[mesh]]\nfile = \"bad.obj\"\n", "bad.obj:1: y of v is missing"},
        {"[[mesh]]\nfile = \"\"\n", "the file name is empty"},
        {"[[mesh]]\nfile = \".\"\n", "is a directory"},
        {"a = \n", "s.toml:1:"},
        {"a = 1\na = 2\n", "not valid TOML"},
        {std::string("\0\xff\x1b", 3), "s.toml:1:1: not valid TOML"},
        {std::string(100000, '['), "not valid TOML"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = message_of(text, folder.path());
        EXPECT_NE(message.find(expected), std::string::npos)
            << text.substr(0, 200) << "\n says: '" << message << "'\n not: " << expected;
        EXPECT_TRUE(message.starts_with("s.toml:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    // Where the file's own folder is the current one, too.
    EXPECT_EQ(message_of("[[mesh]]\nfile = \"\"\n"), "s.toml:2:8: the file name is empty; give a model");
    EXPECT_EQ(message_of("[camera]\nfrom = \"\"\n[[mesh]]\nshape = \"box\"\n"),
              "s.toml:2:8: '' brings no camera; give a .gltf or .glb file");
}

} // namespace
} // namespace razor
