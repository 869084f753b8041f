// MD3 models with pictures: what is rendered of them and told about them.
#include "tests/program/run.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/temporary_folder.h"
#include "tests/scene/tga_writer.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace razor {
namespace {

/// Colours that all differ, so that nothing can be upside down or mirrored unseen.
std::vector<TgaColour> squares(int seed) {
    std::vector<TgaColour> texels;
    for (int i = 0; i < 48; ++i)
        texels.push_back({static_cast<std::uint8_t>(i * 5), static_cast<std::uint8_t>(i * seed % 256),
                          static_cast<std::uint8_t>(255 - i * 3), 255});
    return texels;
}
std::string as_png(const std::vector<TgaColour>& texels) {
    std::vector<std::uint8_t> samples;
    for (const TgaColour& c : texels)
        samples.insert(samples.end(), c.begin(), c.begin() + 3);
    return png_of(8, 6, {}, samples);
}

/// Two rectangles beside each other, of a surface each, in game/models/roof.md3, and the same as roof.obj,
/// whose texture coordinates run upwards.
class Md3Pictures : public testing::Test {
protected:
    Md3Pictures() {
        for (const char* const folder : {"game/models", "game/textures"})
            std::filesystem::create_directories(folder_ / folder);
        const std::vector<std::array<int, 3>> clockwise{{0, 2, 1}, {0, 3, 2}};
        Md3SurfaceData left{"left", clockwise, {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
                            {},     {},        {"textures/left.tga"}};
        left.frame_steps = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}}};
        Md3SurfaceData right{"right", clockwise, {{0.25F, 0.75F}, {2, 0.75F}, {2, 0.25F}, {0.25F, 0.25F}},
                             {},      {},        {"models/right"}};
        right.frame_steps = {{{64, 0, 0}, {128, 0, 32}, {128, 64, 32}, {64, 64, 0}}};
        folder_.file("game/models/roof.md3", write_md3({left, right}, 1));
        folder_.file("roof.obj",
                     "mtllib roof.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0.5\nv 2 1 0.5\n"
                     "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.25 0.25\nvt 2 0.25\nvt 2 0.75\nvt 0.25 0.75\n"
                     "usemtl a\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
                     "usemtl b\nf 2/5 5/6 6/7\nf 2/5 6/7 3/8\n");
        folder_.file("roof.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\nnewmtl b\nKd 1 1 1\nmap_Kd b.png\n");
        folder_.file("a.png", as_png(squares(3)));
        folder_.file("b.png", as_png(squares(7)));
        folder_.file("game/textures/left.tga", tga_of(8, 6, {.type = 10, .bits = 32}, squares(3)));
        folder_.file("game/models/right.png", as_png(squares(7)));
    }
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }
    /// Renders both; whether all of their bits agree.
    bool are_equal(const std::string& options) const {
        for (const char* const model : {"game/models/roof.md3 -o m.exr", "roof.obj -o o.exr"}) {
            const Outcome result =
                razor(std::string("render ") + model + " --size 48x40 --spp 4 --quiet " + options);
            EXPECT_EQ(result.code, 0) << result.err;
            EXPECT_EQ(result.err, "");
        }
        return razor("compare m.exr o.exr --identical").code == 0;
    }
    TemporaryFolder folder_;
};

TEST_F(Md3Pictures, AreTheBitsOfAnEqualObjModel) {
    for (const char* const options : {"--scheme bilinear", "--up z"})
        EXPECT_TRUE(are_equal(options)) << options;
    folder_.file("a.png", as_png(squares(4)));
    EXPECT_FALSE(are_equal("--scheme bilinear")) << "it is seen";
    folder_.file("game/models/roof_default.skin", "left,textures/new.tga\n");
    folder_.file("game/textures/new.jpg", as_png(squares(4)));
    EXPECT_TRUE(are_equal("--scheme bilinear")) << "a skin's picture";
}

TEST_F(Md3Pictures, AreListed) {
    const auto told = [&](const std::string& lines) {
        const Outcome result = razor("info game/models/roof.md3 --json i.json");
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find(lines), std::string::npos) << lines << result.out;
        std::ifstream file(folder_ / "i.json");
        return nlohmann::json::parse(file);
    };
    const std::string root = (folder_ / "game").string(), model = root + "/models/roof.md3";
    const auto json = told(model + ": 1 frame; surfaces: left, right\n  left: textures/left.tga, " + root +
                           "/textures/left.tga\n  right: models/right, " + root + "/models/right.png\n");
    EXPECT_EQ(json["md3_files"][0]["shaders"], nlohmann::json({"textures/left.tga", "models/right"}));
    EXPECT_EQ(json["md3_files"][0]["pictures"],
              nlohmann::json({root + "/textures/left.tga", root + "/models/right.png"}));
    EXPECT_EQ(json["materials"][2]["name"], "textures/left.tga");
    EXPECT_EQ(json["materials"][2]["faces"], 2);
    EXPECT_EQ(json["textures"][0]["file"], root + "/textures/left.tga");
    std::filesystem::remove(folder_ / "game/models/right.png");
    const auto less = told("\n  right: models/right, no picture\n");
    EXPECT_EQ(less["md3_files"][0]["pictures"][1], nlohmann::json());
}

TEST_F(Md3Pictures, ThatAreMissingAreNoted) {
    std::filesystem::remove(folder_ / "game/models/right.png");
    const std::string note =
        (folder_ / "game/models/roof.md3").string() +
        ": no picture 'models/right'; put it beside the model, or where its path leads from "
        "there or from a folder above\n";
    for (const char* const command : {"info game/models/roof.md3", "check game/models/roof.md3"})
        EXPECT_NE(razor(command).out.find("not read: " + note), std::string::npos) << razor(command).out;
    const Outcome result = razor("render game/models/roof.md3 --size 8x8 --spp 1 --explain -o m.exr");
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.err.find("razor: " + note), std::string::npos) << result.err;
    folder_.file("game/models/right.png", "GIF89a");
    const Outcome bad = razor("render game/models/roof.md3 --size 8x8 --spp 1 -o m.exr");
    EXPECT_EQ(bad.code, 2);
    EXPECT_EQ(bad.error_lines(), 1);
    EXPECT_NE(bad.err.find("roof.md3: surface 'right': "), std::string::npos) << bad.err;
}

} // namespace
} // namespace razor
