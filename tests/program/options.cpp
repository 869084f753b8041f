// The options that choose and override a scene.
#include "razor/program/arguments.h"
#include "razor/program/scene_options.h"
#include "razor/program/sequence.h"
#include "razor/scene/numbered_name.h"

#include "razor/scene/default_scene.h"
#include "razor/scene/error.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>

namespace razor {
namespace {

SceneDescription described(std::vector<std::string> arguments) {
    CLI::App app("test");
    SceneOptions options;
    options.add_to(app, "scene");
    std::reverse(arguments.begin(), arguments.end()); // CLI11 takes them from the back
    app.parse(arguments);
    return options.describe();
}

TEST(Arguments, ParseOrRefuse) {
    EXPECT_EQ(parse_whole("--n", "12", {1, 20}), 12);
    EXPECT_EQ(parse_number("--x", "0.5", {0, 1}), 0.5);
    EXPECT_EQ(parse_size("--size", "640x480", {1, 1000}), std::pair(640, 480));
    for (const char* bad : {"", "x", "1x", "0", "21", "1.5", "-1", " 1", "1 ", "99999999999999999999"}) {
        EXPECT_THROW(parse_whole("--n", bad, {1, 20}), UserError) << bad;
    }
    for (const char* bad : {"", "x", "nan", "inf", "2", "-0.1", "0.5s", "1e999"}) {
        EXPECT_THROW(parse_number("--x", bad, {0, 1}), UserError) << bad;
    }
    for (const char* bad :
         {"", "640", "640x", "x480", "640x480x3", "0x5", "640X480", "-1x5", "640 x 480", "1001x1"}) {
        EXPECT_THROW(parse_size("--size", bad, {1, 1000}), UserError) << bad;
    }
    EXPECT_EQ(parse_span("--tiles", "3..17", {0, 17}), std::pair(3, 17));
    EXPECT_EQ(parse_span("--tiles", "0..0", {0, 17}), std::pair(0, 0));
    for (const char* bad : {"", "3", "3..", "..3", "3...5", "5..3", "0..18", "-1..3", "3..4..5", "3-5"}) {
        EXPECT_THROW(parse_span("--tiles", bad, {0, 17}), UserError) << bad;
    }
    EXPECT_EQ(parse_span("--frames", "3:17", {0, 17}, ":"), std::pair(3, 17));
    constexpr std::array<std::string_view, 2> words{"y", "z"};
    EXPECT_EQ(parse_choice("--up", "z", words), 1U);
    EXPECT_THROW(parse_choice("--up", "x", words), UserError);
}

TEST(Sequence, FramesAndTheirFiles) {
    EXPECT_EQ(parse_frames("3:17").first, 3);
    EXPECT_EQ(parse_frames("3:17").last, 17);
    EXPECT_EQ(parse_frames("3:17").count(), 15);
    EXPECT_EQ(parse_frames("5").first, 5);
    EXPECT_EQ(parse_frames("5").count(), 1);
    for (const char* bad : {"", ":", "3:", ":3", "5:3", "-1:3", "3..5", "1:2:3", "x"}) {
        EXPECT_THROW(parse_frames(bad), UserError) << bad;
    }
    EXPECT_EQ(numbered("a/%04d.exr", 12), "a/0012.exr");
    EXPECT_EQ(numbered("%d.png", 12345), "12345.png");
    EXPECT_EQ(numbered("50%_%02d.png", 123), "50%_123.png");
    EXPECT_EQ(numbered("%s%0d%.png", 1), "%s%0d%.png") << "no number";
    EXPECT_NO_THROW(check_numbered("-o", "one.png", {4, 4}));
    EXPECT_NO_THROW(check_numbered("-o", "%d.png", {4, 9}));
    EXPECT_THROW(check_numbered("-o", "%d_%04d.png", {4, 9}), UserError);
    EXPECT_THROW(check_numbered("-o", "%d_%d.png", {4, 4}), UserError);
    try {
        check_numbered("-o", "a/one.png", {4, 9});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_STREQ(error.what(),
                     "-o a/one.png: one name for 6 frames; write their number into it: a/one_%04d.png");
    }
}

TEST(SceneOptions, AFrameOfWhatMoves) {
    const TemporaryFolder folder;
    folder.file("s.toml",
                "[[mesh]]\nname = \"a\"\nshape = \"box\"\n[[object]]\nmesh = \"a\"\n[[object.key]]\n"
                "time = 0\ntranslate = [1, 0, 0]\n[[object.key]]\ntime = 1\ntranslate = [2, 0, 0]\n");
    const std::string path = (folder.path() / "s.toml").string();
    EXPECT_EQ(described({path}).objects[0].transform.translate, glm::dvec3(1, 0, 0));
    EXPECT_EQ(described({path, "--frame", "12"}).objects[0].transform.translate, glm::dvec3(1.5, 0, 0));
    EXPECT_FALSE(described({path, "--frame", "12"}).objects[0].keys.any());
    EXPECT_THROW(described({path, "--frame", "-1"}), UserError);
}

TEST(SceneOptions, BuiltInSceneWithoutAName) {
    EXPECT_EQ(to_toml(described({})), to_toml(default_scene()));
}

TEST(SceneOptions, OverrideTheFile) {
    const TemporaryFolder folder;
    const std::string file = folder.file("s.toml", "[settings]\nsamples = 9\n[[mesh]]\nshape = \"box\"\n");
    EXPECT_EQ(described({file}).settings.samples, 9);
    const SceneDescription scene =
        described({file, "--size", "64x32", "--spp", "2", "--light-samples", "3", "--sky-samples", "5",
                   "--seed", "7", "--edge-pixels", "1.5", "--scheme", "bilinear"});
    EXPECT_EQ(scene.settings.width, 64);
    EXPECT_EQ(scene.settings.height, 32);
    EXPECT_EQ(scene.settings.samples, 2);
    EXPECT_EQ(scene.settings.light_samples, 3);
    EXPECT_EQ(scene.settings.sky_samples, 5);
    EXPECT_EQ(scene.settings.seed, 7);
    EXPECT_EQ(scene.settings.edge_pixels, 1.5);
    EXPECT_EQ(scene.meshes[0].scheme, Scheme::bilinear);
}

TEST(SceneOptions, FilterThePicture) {
    const TemporaryFolder folder;
    const std::string file =
        folder.file("s.toml", "[film]\nfilter = \"gaussian\"\nsigma = 2\n[[mesh]]\nshape = \"box\"\n");
    EXPECT_EQ(described({file}).settings.filter.sigma, 2);
    EXPECT_EQ(described({file, "--filter", "mitchell"}).settings.filter, preset_filter(FilterKind::mitchell));
    const Filter wide = described({file, "--filter-radius", "3"}).settings.filter;
    EXPECT_EQ(wide.kind, FilterKind::gaussian);
    EXPECT_EQ(wide.radius, glm::dvec2(3, 3));
    EXPECT_EQ(wide.sigma, 2);
}

TEST(SceneOptions, CropAPartOfThePicture) {
    const TemporaryFolder folder;
    const std::string file = folder.file(
        "s.toml", "[settings]\nsize = [64, 32]\ncrop = [48, 16, 16, 16]\n[[mesh]]\nshape = \"box\"\n");
    EXPECT_EQ(described({file}).settings.crop, (Crop{48, 16, 16, 16}));
    EXPECT_EQ(described({file, "--crop", "1,2,3,4"}).settings.crop, (Crop{1, 2, 3, 4}));
    EXPECT_EQ(described({"--size", "100x80", "--crop", "64,32,36,48"}).settings.crop, (Crop{64, 32, 36, 48}));
    EXPECT_EQ(described({file}).camera.position, described({file, "--crop", "0,0,16,16"}).camera.position);
    const auto complaint = [&](const std::vector<std::string>& arguments) {
        try {
            described(arguments);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(complaint({file, "--size", "32x32"}),
              file +
                  ": the crop of 16 x 16 pixels at (48, 16) is not a part of a picture of 32 x 32; give X, "
                  "Y, WIDTH and HEIGHT of one that is");
    EXPECT_TRUE(complaint({file, "--crop", "60,0,5,5"}).starts_with("--crop: the crop of 5 x 5 pixels"));
    EXPECT_TRUE(complaint({file, "--crop", "0,0,0,5"}).starts_with("--crop: the crop of 0 x 5 pixels"));
    EXPECT_TRUE(complaint({file, "--crop", "0,0,0,0"}).starts_with("--crop: the crop of 0 x 0 pixels"));
    for (const char* wrong : {"1,2,3", "1,2,3,4,5", "1,2,3,", "a,2,3,4", "1,2,-3,4"})
        EXPECT_TRUE(complaint({file, "--crop", wrong}).starts_with("--crop")) << wrong;
}

TEST(SceneOptions, ShapeAModel) {
    const TemporaryFolder folder;
    const std::string file = folder.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 2 3\n");
    const SceneDescription preset = described({file});
    ASSERT_EQ(preset.meshes.size(), 2U);
    EXPECT_EQ(preset.meshes[0].scheme, Scheme::catmull_clark);
    EXPECT_EQ(preset.meshes[0].rotate, glm::dvec3(0));
    const SceneDescription turned = described({file, "--up", "z", "--scheme", "bilinear", "--size", "10x40"});
    EXPECT_EQ(turned.meshes[0].scheme, Scheme::bilinear);
    EXPECT_EQ(turned.meshes[1].scheme, Scheme::bilinear);
    EXPECT_EQ(placed_points(turned.meshes[0])[2], glm::dvec3(0, 2, 0));
    EXPECT_NE(turned.camera.position, described({file, "--up", "z"}).camera.position)
        << "framed for the picture's shape";
    EXPECT_EQ(described({file, "--no-floor"}).meshes.size(), 1U);
    EXPECT_EQ(described({file, "--scheme", "catmark"}).meshes[1].scheme, Scheme::bilinear)
        << "the floor stays flat";
}

TEST(SceneOptions, WrongValuesAreRefusedBeforeAnyFileIsRead) {
    for (const std::vector<std::string>& bad : {std::vector<std::string>{"--spp", "0"},
                                                {"--size", "9"},
                                                {"--light-samples", "x"},
                                                {"--sky-samples", "-1"},
                                                {"--edge-pixels", "0"},
                                                {"--crop", "0,0,8"},
                                                {"--scheme", "loop"},
                                                {"--up", "x"}}) {
        std::vector<std::string> arguments = bad;
        arguments.push_back("missing.obj");
        try {
            described(arguments);
            ADD_FAILURE() << bad[0];
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find(bad[0]), std::string::npos) << error.what();
        }
    }
}

} // namespace
} // namespace razor
