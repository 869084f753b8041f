// Radiance pictures: every way in which their scanlines are stored, what their header says, and damage.
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/shared_exponent.h"
#include "tests/scene/radiance_writer.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor {
namespace {

glm::vec3 texel(const TexturePyramid& p, std::size_t x, std::size_t y) {
    const TextureLevel& level = p.levels[0];
    const auto columns = static_cast<std::size_t>(level.width + 3) / 4;
    return unpack_shared_exponent(level.texels[16 * (y / 4 * columns + x / 4) + 4 * (y % 4) + x % 4]);
}
/// From the file format's text: by powers of two, so that it is exact but for packing.
glm::dvec3 light(const RgbePixel& p) {
    const double unit = std::pow(2.0, p[3] - 128) / 256;
    return {unit * (p[0] + 0.5), unit * (p[1] + 0.5), unit * (p[2] + 0.5)};
}
void expect_near(const glm::vec3& got, const glm::dvec3& want) {
    const double bound = std::max({want.x, want.y, want.z}) * 0x1p-9;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c], want[c], bound) << c;
}
std::string message(const std::string& bytes) {
    try {
        decode_picture(bytes, "x", false);
    } catch (const UserError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
    return "";
}

TEST(Radiance, ScanlinesOfEveryKind) {
    for (const RadianceRuns runs : {RadianceRuns::none, RadianceRuns::old, RadianceRuns::each})
        for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{8, 3}, {300, 2}, {1000, 1}}) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(runs) << ' ' << width);
            std::vector<RgbePixel> pixels = ramp_of_pixels(width * height);
            std::fill_n(pixels.begin(), width - 3, pixels[0]); // long runs
            const TexturePyramid p = decode_picture(radiance_of(width, height, pixels, runs), "x", false);
            ASSERT_EQ(p.levels[0].width, static_cast<int>(width));
            ASSERT_EQ(p.levels[0].height, static_cast<int>(height));
            EXPECT_TRUE(p.levels[0].opacity.empty());
            for (std::size_t y = 0; y < height; ++y)
                for (std::size_t x = 0; x < width; ++x)
                    expect_near(texel(p, x, y), light(pixels[y * width + x]));
        }
    // Narrower than scanlines with run lengths of their own can be: these are pixels.
    const RgbePixel alike{2, 2, 0, 130};
    expect_near(texel(decode_picture(radiance_of(1, 1, {alike}, RadianceRuns::none), "x", false), 0, 0),
                light(alike));
}

TEST(Radiance, BlackAndWhatIsBrighterThanTexelsHold) {
    const std::vector<RgbePixel> pixels{{200, 100, 50, 0}, {255, 255, 255, 255}, {0, 255, 0, 128}};
    const TexturePyramid p = decode_picture(radiance_of(3, 1, pixels, RadianceRuns::none), "x", false);
    EXPECT_EQ(texel(p, 0, 0), glm::vec3(0));
    EXPECT_EQ(texel(p, 1, 0), glm::vec3(most_shared));
    expect_near(texel(p, 2, 0), {0.5 / 256, 255.5 / 256, 0.5 / 256});
}

TEST(Radiance, WhatPixelsWereMultipliedByIsDividedOut) {
    const std::vector<RgbePixel> pixels{{128, 64, 32, 129}};
    const auto read = [&](const std::string& header) {
        return texel(decode_picture(radiance_of(1, 1, pixels, RadianceRuns::none, header), "x", false), 0, 0);
    };
    const glm::dvec3 plain = light(pixels[0]);
    expect_near(read(""), plain);
    expect_near(read("EXPOSURE=4\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 0.5 \n"), plain / 2.0);
    expect_near(read("COLORCORR=1 2 4\r\nPRIMARIES=0 1 2 3 4 5 6 7\n"), plain / glm::dvec3(1, 2, 4));
}

TEST(Radiance, AreMapsOfTheSkyAndHeights) {
    const TemporaryFolder folder;
    const RgbePixel pixel{128, 64, 32, 130};
    folder.file("s.hdr", radiance_of(9, 4, std::vector<RgbePixel>(36, pixel), RadianceRuns::each));
    const Scene scene = build_scene(parse_scene_file(R"(
        [[texture]]
        name = "s"
        file = "s.hdr"
        [[material]]
        name = "m"
        displacement_map = "s"
        [sky]
        map = "s"
        [[mesh]]
        shape = "plane")",
                                                     "s.toml", folder.path()));
    ASSERT_EQ(scene.textures.size(), 1U);
    expect_near(texel(*scene.textures[0].pyramid, 8, 3), light(pixel));
    EXPECT_EQ(scene.textures[0].heights->most, static_cast<float>(light(pixel).x)) << "without packing";
}

TEST(Radiance, DamageIsOneClearLine) {
    const std::string good = radiance_of(9, 3, ramp_of_pixels(27), RadianceRuns::each);
    EXPECT_EQ(message(good), "");
    for (std::size_t size = 10; size < good.size(); ++size) {
        const std::string cut = message(good.substr(0, size));
        EXPECT_TRUE(cut.starts_with("x: ")) << size << cut;
        EXPECT_NE(cut.find("; give another picture"), std::string::npos) << size << cut;
    }
    const std::string text = "#?RADIANCE\n\n";
    const std::pair<std::string, const char*> cases[] = {
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "is of format '32-bit_rle_xyze', not"},
        {"#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\nabcd", "has EXPOSURE '0', which is no factor"},
        {"#?RADIANCE\nCOLORCORR=1 2\n\n-Y 1 +X 1\nabcd", "has COLORCORR '', which is no factor"},
        {text + "+Y 1 +X 1\nabcd", "lies as '+Y 1 +X 1', not from the top left, row by row ('-Y 1 +X 1')"},
        {text + "-Y 1 +X\nabcd", "has '-Y 1 +X' where its size belongs"},
        {text + "-Y 1 +X 1 2\nabcd", "has '-Y 1 +X 1 2' where its size belongs"},
        {text + "-Y 0 +X 1\nabcd", "1 x 0 texels are none"},
        {text + "-Y 32768 +X 32768\nabcd", "texels are too many"},
        {text + "-Y 8000 +X 8000\nabcd", "cannot be in"},
        {text + "-Y 1 +X 1\nabc", "the file ends in row 1 of 1"},
        {text + "-Y 1 +X 9\n\2\2\1\2" + std::string(40, '\1'), "a scanline is of another length in row 1"},
        {text + "-Y 1 +X 9\n\2\2" + std::string("\0\11\212", 3) + "a", "a run is of no pixel, or of more"},
        {text + "-Y 1 +X 9\n\2\2" + std::string("\0\11\0", 3) + "a", "a run is of no pixel, or of more"},
        {text + "-Y 1 +X 2\n\1\1\1\1abcd", "a run is of no pixel, or of more than there are, in row 1 of 1"},
        {text + "-Y 1 +X 2\nabcd\1\1\1\2", "a run is of no pixel, or of more than there are, in row 1 of 1"},
    };
    for (const auto& [bytes, cause] : cases)
        EXPECT_NE(message(bytes).find(cause), std::string::npos) << cause << '\n' << message(bytes);
}

} // namespace
} // namespace razor
