// Pictures as pyramids: every kind that is read, means of every size, packing, damage, limits.
#include "razor/scene/description.h"
#include "razor/scene/error.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/shared_exponent.h"
#include "razor/scene/textures/srgb.h"
#include "razor/scene/textures/texture_cache.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/temporary_folder.h"

#include <glm/vec4.hpp>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace razor {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

std::size_t word_of(const TextureLevel& level, int x, int y) {
    const int columns = (level.width + 3) / 4;
    return static_cast<std::size_t>(16 * (y / 4 * columns + x / 4) + 4 * (y % 4) + x % 4);
}

glm::vec3 colour(const TextureLevel& level, int x, int y) {
    return unpack_shared_exponent(level.texels[word_of(level, x, y)]);
}

float opacity(const TextureLevel& level, int x, int y) {
    return level.opacity.empty() ? 1.0F : unpack_shared_exponent(level.opacity[word_of(level, x, y)]).y;
}

void expect_near(const glm::dvec3& got, const glm::dvec3& want, const std::string& what) {
    const double bar = std::max({want.x, want.y, want.z}) * 0x1p-9 + 0x1p-25;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c], want[c], bar) << what << " component " << c;
}

float linear(int encoded, int most = 255) {
    return static_cast<float>(srgb_to_linear(double(encoded) / most));
}

TEST(Srgb, IsTheStandardsCurve) {
    EXPECT_EQ(srgb_to_linear(0), 0);
    EXPECT_EQ(srgb_to_linear(1), 1);
    EXPECT_NEAR(srgb_to_linear(0.04045), 0.04045 / 12.92, 1e-15);
    EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114048223255, 1e-15);
    EXPECT_NEAR(srgb_to_linear(188 / 255.0), 0.50288646, 1e-8);
}

TEST(SharedExponent, IsWithinItsBound) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-20, 15.99F), part(0, 1);
    for (int i = 0; i < 200000; ++i) {
        glm::vec3 c(part(random), i % 3 == 0 ? 0 : part(random), i % 5 == 0 ? 1 : part(random));
        c *= std::exp2(exponent(random));
        c = glm::vec3(std::min(c.x, most_shared), std::min(c.y, most_shared), std::min(c.z, most_shared));
        const float largest = std::max({c.x, c.y, c.z});
        const glm::vec3 again = unpack_shared_exponent(pack_shared_exponent(c));
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(again[k], c[k], largest * 0x1p-9F + 0x1p-25F) << c[k];
        EXPECT_EQ(unpack_shared_exponent(pack_shared_exponent(again)), again) << "packed again";
    }
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const auto again = [](float x, float y, float z) {
        return unpack_shared_exponent(pack_shared_exponent({x, y, z}));
    };
    EXPECT_EQ(again(0, -1, std::numeric_limits<float>::quiet_NaN()), glm::vec3(0));
    EXPECT_EQ(again(1, 0.5F, 0.25F), glm::vec3(1, 0.5F, 0.25F));
    EXPECT_EQ(again(infinite, 1e30F, -infinite), glm::vec3(most_shared, most_shared, 0));
    EXPECT_EQ(again(65407, 1, 0), glm::vec3(most_shared, 0, 0));
    EXPECT_EQ(again(0.9999F, 0, 0), glm::vec3(1, 0, 0)) << "rounds up to the next power of two";
    EXPECT_EQ(again(0x1p-24F, 0, 0), glm::vec3(0x1p-24F, 0, 0));
    EXPECT_EQ(again(1e-30F, 0, 0), glm::vec3(0));
}

/// The pyramid by its definition, in double precision.
struct Picture {
    int width = 0, height = 0;
    std::vector<glm::dvec4> texels;
};

Picture above(const Picture& p) {
    Picture mean{(p.width + 1) / 2, (p.height + 1) / 2, {}};
    const double w = double(p.width) / mean.width, h = double(p.height) / mean.height;
    for (int j = 0; j < mean.height; ++j)
        for (int i = 0; i < mean.width; ++i) {
            glm::dvec4 sum(0);
            for (int y = 0; y < p.height; ++y)
                for (int x = 0; x < p.width; ++x) {
                    const double dx = std::min(x + 1.0, (i + 1) * w) - std::max<double>(x, i * w);
                    const double dy = std::min(y + 1.0, (j + 1) * h) - std::max<double>(y, j * h);
                    if (dx > 0 && dy > 0)
                        sum += dx * dy * p.texels[static_cast<std::size_t>(y * p.width + x)];
                }
            mean.texels.push_back(sum / (w * h));
        }
    return mean;
}

TEST(Pyramid, HasTheMeansOfEverySize) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> part(0, 1);
    const std::pair<int, int> sizes[] = {{1, 1}, {2, 2},   {1, 7},   {9, 1},  {3, 3},   {5, 4},
                                         {8, 8}, {13, 11}, {31, 17}, {2, 33}, {64, 16}, {127, 3}};
    for (const auto& [width, height] : sizes) {
        for (const bool opaque : {true, false}) {
            Picture want{width, height, {}};
            PyramidBuilder builder(width, height);
            std::vector<glm::vec4> row(static_cast<std::size_t>(width));
            for (int y = 0; y < height; ++y) {
                for (glm::vec4& t : row) {
                    t = {part(random), 4 * part(random), part(random), opaque ? 1 : part(random)};
                    want.texels.emplace_back(t);
                }
                builder.add_row(row);
            }
            const TexturePyramid got = builder.finish();
            for (std::size_t l = 0; l < got.levels.size(); ++l) {
                const TextureLevel& level = got.levels[l];
                const std::string what =
                    std::to_string(width) + "x" + std::to_string(height) + " level " + std::to_string(l);
                ASSERT_EQ(level.width, want.width) << what;
                ASSERT_EQ(level.height, want.height) << what;
                const int tiles_x = (want.width + 3) / 4, tiles_y = (want.height + 3) / 4;
                ASSERT_EQ(level.texels.size(), static_cast<std::size_t>(16 * tiles_x * tiles_y)) << what;
                ASSERT_EQ(level.opacity.size(), opaque ? 0 : level.texels.size()) << what;
                for (int y = 0; y < 4 * tiles_y; ++y)
                    for (int x = 0; x < 4 * tiles_x; ++x) {
                        const int cx = std::min(x, want.width - 1), cy = std::min(y, want.height - 1);
                        const glm::dvec4& t = want.texels[static_cast<std::size_t>(cy * want.width + cx)];
                        expect_near(colour(level, x, y), t, what);
                        EXPECT_NEAR(opacity(level, x, y), t.w, t.w * 0x1p-9 + 0x1p-25) << what;
                    }
                if (l + 1 < got.levels.size())
                    want = above(want);
            }
            EXPECT_EQ(got.levels.back().width * got.levels.back().height, 1);
        }
    }
}

TEST(Pyramid, HasNoMoreLevelsThanAreAllowed) {
    PyramidBuilder wide(most_picture_side, 1);
    std::vector<glm::vec4> row(most_picture_side, glm::vec4(0.5F, 1, 2, 1));
    wide.add_row(row);
    const TexturePyramid pyramid = wide.finish();
    EXPECT_EQ(pyramid.levels.size(), static_cast<std::size_t>(most_texture_levels));
    for (const TextureLevel& level : pyramid.levels)
        EXPECT_EQ(colour(level, level.width - 1, 0), glm::vec3(0.5F, 1, 2));
}

TEST(Pyramid, TellsOpacityFromTheFirstTexelThatHasSome) {
    PyramidBuilder builder(2, 3);
    std::vector<glm::vec4> row(2, glm::vec4(1));
    builder.add_row(row);
    row[1].w = 0;
    builder.add_row(row);
    row[1].w = 1;
    builder.add_row(row);
    const TexturePyramid p = builder.finish();
    EXPECT_EQ(opacity(p.levels[0], 1, 0), 1);
    EXPECT_EQ(opacity(p.levels[0], 1, 1), 0);
    EXPECT_EQ(opacity(p.levels[0], 0, 1), 1);
    EXPECT_EQ(colour(p.levels[0], 1, 1), glm::vec3(1)) << "colours are not multiplied by it";
    EXPECT_NEAR(opacity(p.levels[2], 0, 0), 5 / 6.0, 0x1p-9);
}

TEST(Png, OfEveryKind) {
    const auto texel = [](const std::string& png, int x, int y, bool is_linear = false) {
        const TexturePyramid p = decode_png(png, "t", is_linear);
        return glm::vec4(colour(p.levels[0], x, y), opacity(p.levels[0], x, y));
    };
    const auto expect = [](const glm::vec4& got, const glm::vec4& want, const char* what) {
        expect_near(glm::vec3(got), glm::vec3(want), what);
        EXPECT_NEAR(got.w, want.w, 0x1p-9) << what;
    };
    for (const bool interlaced : {false, true}) {
        PngKind rgb{.interlaced = interlaced};
        Bytes samples;
        for (int i = 0; i < 3 * 9 * 7; ++i)
            samples.push_back(static_cast<std::uint8_t>(i));
        const std::string png = png_of(9, 7, rgb, samples);
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 9; ++x) {
                const int i = 3 * (9 * y + x);
                expect(texel(png, x, y), {linear(i), linear(i + 1), linear(i + 2), 1}, "8-bit RGB");
            }
        EXPECT_EQ(decode_png(png, "t", false).levels[0].opacity.size(), 0U);
    }
    expect(texel(png_of(1, 1, {}, {51, 102, 204}), 0, 0, true), {0.2F, 0.4F, 0.8F, 1}, "linear");
    expect(texel(png_of(1, 1, {.colour = PNG_COLOR_TYPE_RGB_ALPHA}, {51, 102, 204, 51}), 0, 0),
           {linear(51), linear(102), linear(204), 0.2F}, "8-bit RGBA");
    expect(texel(png_of(1, 1, {.colour = PNG_COLOR_TYPE_GRAY}, {77}), 0, 0),
           glm::vec4(glm::vec3(linear(77)), 1), "8-bit grey");
    expect(texel(png_of(1, 1, {.colour = PNG_COLOR_TYPE_GRAY_ALPHA}, {77, 102}), 0, 0),
           glm::vec4(glm::vec3(linear(77)), 0.4F), "8-bit grey with opacity");
    const PngKind wide{.depth = 16};
    expect(texel(png_of(1, 1, wide, {0x12, 0x34, 0x80, 0x00, 0xff, 0xff}), 0, 0),
           {linear(0x1234, 65535), linear(0x8000, 65535), 1, 1}, "16-bit RGB");
    expect(texel(png_of(1, 1, {.depth = 16, .colour = PNG_COLOR_TYPE_GRAY_ALPHA}, {0x12, 0x34, 0x80, 0}), 0,
                 0, true),
           glm::vec4(glm::vec3(0x1234 / 65535.0F), 0x8000 / 65535.0F), "16-bit grey with opacity");
    for (const int depth : {1, 2, 4}) {
        const int most = (1 << depth) - 1;
        const std::string png = png_of(2, 1, {.depth = depth, .colour = PNG_COLOR_TYPE_GRAY},
                                       {static_cast<std::uint8_t>(1 << (8 - 2 * depth))});
        expect(texel(png, 0, 0), {0, 0, 0, 1}, "few bits");
        expect(texel(png, 1, 0), glm::vec4(glm::vec3(linear(1, most)), 1), "few bits");
    }
    const PngKind palette{.depth = 4,
                          .colour = PNG_COLOR_TYPE_PALETTE,
                          .palette = {{1, 2, 3}, {200, 100, 50}, {9, 9, 9}},
                          .palette_opacity = {255, 51}};
    const std::string indexed = png_of(3, 1, palette, {0x01, 0x20});
    expect(texel(indexed, 0, 0), {linear(1), linear(2), linear(3), 1}, "palette");
    expect(texel(indexed, 1, 0), {linear(200), linear(100), linear(50), 0.2F}, "palette");
    expect(texel(indexed, 2, 0), {linear(9), linear(9), linear(9), 1}, "palette");
    const std::string keyed = png_of(2, 1, {.colour = PNG_COLOR_TYPE_GRAY, .transparent_grey = 7}, {7, 8});
    EXPECT_EQ(texel(keyed, 0, 0).w, 0);
    EXPECT_EQ(texel(keyed, 1, 0).w, 1);
}

TEST(Jpeg, IsReadWithinItsLoss) {
    Bytes grey, rgb;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 40; ++x) {
            grey.push_back(static_cast<std::uint8_t>(5 * x));
            rgb.insert(rgb.end(), {static_cast<std::uint8_t>(4 * x), static_cast<std::uint8_t>(8 * y), 90});
        }
    for (const bool progressive : {false, true}) {
        const TexturePyramid g = decode_jpeg(jpeg_of(40, 24, 1, grey, progressive), "t", true),
                             c = decode_jpeg(jpeg_of(40, 24, 3, rgb, progressive), "t", false);
        EXPECT_EQ(c.levels[0].width, 40);
        EXPECT_EQ(c.levels[0].height, 24);
        EXPECT_TRUE(c.levels[0].opacity.empty());
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 40; ++x) {
                EXPECT_NEAR(colour(g.levels[0], x, y).y, static_cast<float>(5 * x) / 255, 0.02);
                EXPECT_NEAR(colour(c.levels[0], x, y).x, linear(4 * x), 0.03) << x << " " << y;
                EXPECT_NEAR(colour(c.levels[0], x, y).y, linear(8 * y), 0.03) << x << " " << y;
                EXPECT_NEAR(colour(c.levels[0], x, y).z, linear(90), 0.03) << x << " " << y;
            }
    }
    EXPECT_NE(message_of([] {
                  decode_picture(jpeg_of(8, 8, 4, Bytes(256, 99)), "inks.jpg", false);
              }).find("inks.jpg: a JPEG picture of inks (CMYK)"),
              std::string::npos);
}

TEST(Exr, IsLinearWhereverItsWindowLies) {
    const ExrPlanes planes{{"A", {1, 0.5F, 7, 1, 1, 1}},
                           {"B", {0, 0, 0, 0, 0, 1e6F}},
                           {"G", {0.25F, 0.5F, 1, 2, 4, 8}},
                           {"R", {6, 5, 4, 3, 2, 1}}};
    const TexturePyramid p = decode_exr(exr_of(3, 2, planes, -7, 100), "t");
    const TextureLevel& level = p.levels[0];
    expect_near(colour(level, 0, 0), {6, 0.25, 0}, "first");
    expect_near(colour(level, 0, 1), {3, 2, 0}, "second row");
    EXPECT_EQ(colour(level, 2, 1).z, most_shared);
    EXPECT_EQ(opacity(level, 1, 0), 0.5F);
    EXPECT_EQ(opacity(level, 2, 0), 1);
    const TexturePyramid grey = decode_exr(exr_of(2, 1, {{"Y", {0.25F, 0.5F}}}), "t");
    EXPECT_EQ(colour(grey.levels[0], 1, 0), glm::vec3(0.5F));
    EXPECT_EQ(colour(grey.levels[1], 0, 0), glm::vec3(0.375F));
    const TexturePyramid red = decode_exr(exr_of(1, 1, {{"R", {0.5F}}}), "t");
    EXPECT_EQ(colour(red.levels[0], 0, 0), glm::vec3(0.5F, 0, 0));
}

/// Filters leave such numbers beside what is bright: they are dark, and counted.
TEST(Exr, NumbersBelowZeroAreNone) {
    const ExrPlanes planes{{"R", {1, -0.25F, 1, 1}}, {"G", {1, 1, -4e-5F, 1}}, {"B", {0, 0, 0, 0}}};
    const TexturePyramid p = decode_exr(exr_of(2, 2, planes), "f.exr");
    expect_near(colour(p.levels[0], 1, 0), {0, 1, 0}, "red");
    expect_near(colour(p.levels[0], 0, 1), {1, 0, 0}, "green");
    expect_near(colour(p.levels[1], 0, 0), {0.75, 0.75, 0}, "means are of what they are taken as");
    EXPECT_EQ(p.below_zero, 2);
    EXPECT_EQ(p.lowest, -0.25F);
    SceneDescription scene;
    scene.textures.resize(2); // of one picture
    for (Texture& texture : scene.textures) {
        texture.file = "/f.exr";
        texture.pyramid = std::make_shared<const TexturePyramid>(p);
    }
    EXPECT_EQ(notes_of(scene), std::vector<std::string>{
                                   "/f.exr: 2 of its numbers are below 0, down to -0.25, and taken as 0"});
    const TexturePyramid heights = decode_picture(exr_of(2, 2, planes), "f.exr", true, Texels::heights);
    EXPECT_EQ(heights.below_zero, 0);
    EXPECT_EQ(heights.least, -0.25F);
}

TEST(Exr, MistakesNameTheTexel) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const auto message = [](float green) {
        return message_of([&] {
            decode_picture(exr_of(2, 2, {{"R", {1, 1, 1, 1}}, {"G", {1, 1, green, 1}}, {"B", {0, 0, 0, 0}}}),
                           "f.exr", false);
        });
    };
    EXPECT_EQ(message(1), "");
    EXPECT_EQ(message(nan), "f.exr: G of the texel in column 0, row 1 is nan; give colours that are finite");
    EXPECT_NE(message(std::numeric_limits<float>::infinity()).find("is inf;"), std::string::npos);
    EXPECT_NE(message_of([] {
                  decode_exr(exr_of(1, 1, {{"Z", {1}}}), "f.exr");
              }).find("f.exr: has neither channels R, G, B nor Y"),
              std::string::npos);
}

/// All pictures whose bytes are cut or changed somewhere: read, or refused with one line that names them.
TEST(Pictures, DamageIsOneClearLine) {
    Bytes samples;
    for (int i = 0; i < 3 * 16 * 16; ++i)
        samples.push_back(static_cast<std::uint8_t>(i * i));
    const ExrPlanes planes{{"R", std::vector<float>(256, 0.5F)}, {"G", std::vector<float>(256, 2)}};
    const std::string pictures[] = {
        png_of(16, 16, {}, samples), png_of(16, 16, {.interlaced = true}, samples),
        jpeg_of(16, 16, 3, samples), jpeg_of(16, 16, 3, samples, true), exr_of(16, 16, planes)};
    std::mt19937 random(3);
    for (const std::string& whole : pictures) {
        ASSERT_EQ(message_of([&] { decode_picture(whole, "w", false); }), "");
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const std::string message =
                message_of([&] { decode_picture(whole.substr(0, size), "cut", false); });
            EXPECT_TRUE(message.starts_with("cut: ")) << message << " " << size << " of " << whole.size();
            EXPECT_EQ(message.find('\n'), std::string::npos);
        }
        for (int trial = 0; trial < 3000; ++trial) {
            std::string changed = whole;
            for (int n = 0; n <= trial % 3; ++n)
                changed[random() % whole.size()] = static_cast<char>(random());
            const std::string message = message_of([&] { decode_picture(changed, "odd", false); });
            EXPECT_TRUE(message.empty() || message.starts_with("odd: ")) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos);
        }
    }
}

TEST(Pictures, WhatIsNotReadIsNamed) {
    const auto message = [](std::string_view bytes) {
        return message_of([&] { decode_picture(bytes, "x", false); });
    };
    EXPECT_EQ(message(""), "x: is empty; give PNG, JPEG, TGA, OpenEXR or Radiance");
    EXPECT_EQ(message("hello"), "x: is no picture that is read; give PNG, JPEG, TGA, OpenEXR or Radiance");
    EXPECT_EQ(message("GIF89a"), "x: is a GIF picture; convert it to PNG, JPEG, TGA, OpenEXR or Radiance");
    EXPECT_NE(message("version https://git-lfs.github.com/spec/v1\n").find("Git LFS"), std::string::npos);
    const TemporaryFolder folder;
    EXPECT_NE(message_of([&] { read_picture(folder / "none.png", false); }).find("none.png: no such file"),
              std::string::npos);
    EXPECT_NE(message_of([&] { read_picture(folder.file("e.png", ""), false); }).find("e.png: is empty"),
              std::string::npos);
    EXPECT_NE(message_of([&] { read_picture(folder.path(), false); }).find("is a directory"),
              std::string::npos);
}

/// Sizes that headers claim are refused before they are allocated.
TEST(Pictures, BombsAreRefused) {
    std::string png = png_of(1, 1, {}, {1, 2, 3});
    const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
        std::string bomb = png;
        for (int i = 0; i < 4; ++i) {
            bomb[16 + static_cast<std::size_t>(i)] = static_cast<char>(width >> (24 - 8 * i));
            bomb[20 + static_cast<std::size_t>(i)] = static_cast<char>(height >> (24 - 8 * i));
        }
        const auto crc = static_cast<std::uint32_t>(
            crc32(0, reinterpret_cast<const unsigned char*>(bomb.data()) + 12, 17));
        for (int i = 0; i < 4; ++i)
            bomb[29 + static_cast<std::size_t>(i)] = static_cast<char>(crc >> (24 - 8 * i));
        return message_of([&] { decode_picture(bomb, "b", false); });
    };
    EXPECT_EQ(with_size(1, 1), "");
    EXPECT_EQ(with_size(32769, 1), "b: 32769 x 1 texels are too many; give at most 32768 x 32768");
    EXPECT_NE(with_size(1, 0x7fffffff).find("too many"), std::string::npos);
    EXPECT_EQ(with_size(32768, 32768), "b: 32768 x 32768 texels are too many; give at most 536870912 in all");
    EXPECT_NE(with_size(16384, 16384).find("cannot be in"), std::string::npos);
    std::string jpeg = jpeg_of(8, 8, 1, Bytes(64, 5));
    const std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    jpeg.replace(frame + 5, 4, "\x7f\xff\x7f\xff");
    EXPECT_NE(message_of([&] { decode_picture(jpeg, "b", false); }).find("too many"), std::string::npos);
    jpeg.replace(frame + 5, 4, "\x3f\xff\x3f\xff");
    EXPECT_NE(message_of([&] { decode_picture(jpeg, "b", false); }).find("cannot be in"), std::string::npos);
    std::string exr = exr_of(1, 1, {{"R", {1}}});
    const std::size_t window = exr.find("dataWindow") + 11 + 6 + 4;
    exr.replace(window + 8, 8, std::string("\xff\xff\xff\x7e\xff\xff\xff\x7e", 8));
    EXPECT_NE(message_of([&] { decode_picture(exr, "b", false); }).find("too many"), std::string::npos);
    exr.replace(window + 8, 8, std::string("\xff\x3f\0\0\xff\x3f\0\0", 8));
    EXPECT_NE(message_of([&] { decode_picture(exr, "b", false); }).find("cannot be in"), std::string::npos);
}

TEST(Heights, AreTheFilesOwnRed) {
    const TexturePyramid exr =
        decode_picture(exr_of(2, 2, {{"Y", {-3, 1e6F, 0.123456789F, 5}}}), "h", false, Texels::heights);
    EXPECT_EQ(exr.kind, Texels::heights);
    EXPECT_EQ(exr.least, -3);
    EXPECT_EQ(exr.most, 1e6F);
    ASSERT_EQ(exr.levels.size(), 2U);
    EXPECT_EQ(std::bit_cast<float>(exr.levels[0].texels[4]), 0.123456789F) << "all bits";
    EXPECT_NEAR(std::bit_cast<float>(exr.levels[1].texels[0]), (1e6 + 2.123456789) / 4, 0.1);
    const TexturePyramid png = decode_picture(png_of(1, 1, {}, {51, 200, 255}), "h", false, Texels::heights);
    EXPECT_EQ(png.most, 51.0F / 255);
    EXPECT_EQ(message_of([] {
                  decode_exr(exr_of(1, 1, {{"R", {std::numeric_limits<float>::quiet_NaN()}}}), "f.exr",
                             Texels::heights);
              }),
              "f.exr: R of the texel in column 0, row 0 is nan; give heights that are finite");
}

TEST(TextureCache, ReadsNoFileTwice) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.file("a.png", png_of(1, 1, {}, {128, 128, 128}));
    TextureCache cache;
    const auto first = cache.read(file, false);
    EXPECT_EQ(first, cache.read(folder.path() / "." / "a.png", false));
    const auto second = cache.read(file, true);
    EXPECT_NE(first, second);
    EXPECT_NE(colour(first->levels[0], 0, 0), colour(second->levels[0], 0, 0));
}

TEST(Pictures, OfRealScenesAreRead) {
    const std::filesystem::path scenes = RAZOR_SHARED_SCENES;
    for (const char* const file :
         {"spot/spot_texture.png", "kenney_city/colormap.png", "oa_map/textures/textures_acc_dm3_concrt.jpg"})
        if (std::filesystem::exists(scenes / file)) {
            EXPECT_GT(read_picture(scenes / file, false).levels.size(), 4U) << file;
        }
}

} // namespace
} // namespace razor
