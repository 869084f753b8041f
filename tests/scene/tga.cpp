// TGA pictures: every type, depth and corner, runs, maps, what is around the texels, and damage.
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/shared_exponent.h"
#include "razor/scene/textures/srgb.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/temporary_folder.h"
#include "tests/scene/tga_writer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace razor {
namespace {

constexpr int width = 7, height = 5;
using Picture = std::vector<TgaColour>;

/// Runs of all lengths, and texels that differ.
Picture picture_of(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    Picture texels;
    while (texels.size() < std::size_t{width} * height) {
        TgaColour c{};
        for (std::uint8_t& channel : c)
            channel = static_cast<std::uint8_t>(random());
        const std::size_t most = std::size_t{width} * height - texels.size();
        texels.insert(texels.end(), std::min<std::size_t>(most, random() % 3 == 0 ? random() % 12 + 2 : 1),
                      c);
    }
    return texels;
}

std::size_t word_at(const TextureLevel& level, int x, int y) {
    const int columns = (level.width + 3) / 4;
    return static_cast<std::size_t>(16 * (y / 4 * columns + x / 4) + 4 * (y % 4) + x % 4);
}

/// The words that a texel of this colour has, numbers from 0 to 1.
std::uint32_t colour_word(glm::dvec3 c, bool linear) {
    glm::vec3 light{};
    for (int i = 0; i < 3; ++i)
        light[i] = static_cast<float>(linear ? c[i] : srgb_to_linear(c[i]));
    return pack_shared_exponent(light);
}
std::uint32_t opacity_word(double opacity) {
    return pack_shared_exponent(glm::vec3(static_cast<float>(opacity)));
}

/// All bits of what is read, beside what `meant` says of each texel: colour, and opacity.
template <class Meant> void expect_texels(const std::string& bytes, bool linear, const Meant& meant) {
    const TexturePyramid p = decode_picture(bytes, "p.tga", linear);
    const TextureLevel& level = p.levels[0];
    ASSERT_EQ(level.width, width);
    ASSERT_EQ(level.height, height);
    bool opaque = true;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec4 want = meant(static_cast<std::size_t>(y * width + x));
            ASSERT_EQ(level.texels[word_at(level, x, y)], colour_word(glm::dvec3(want), linear))
                << x << ' ' << y;
            opaque = opaque && want.w == 1;
            if (!level.opacity.empty()) {
                ASSERT_EQ(level.opacity[word_at(level, x, y)], opacity_word(want.w)) << x << ' ' << y;
            }
        }
    EXPECT_EQ(level.opacity.empty(), opaque);
}

/// Calls test(kind) with each corner that the first texel may be in, with and without runs.
template <class Test> void each_way(TgaKind kind, const Test& test) {
    const int type = kind.type;
    for (const bool runs : {false, true})
        for (const bool right : {false, true})
            for (const bool top : {false, true})
                for (const bool whole_rows : {true, false}) {
                    kind.type = runs ? type + 8 : type;
                    kind.from_right = right;
                    kind.from_top = top;
                    kind.whole_rows = whole_rows;
                    SCOPED_TRACE(testing::Message() << "type " << kind.type << ", " << kind.bits << " bits, "
                                                    << kind.opacity_bits << " of opacity, right " << right
                                                    << ", top " << top << ", whole rows " << whole_rows);
                    test(kind);
                }
}

glm::dvec4 eights(const TgaColour& c, bool opacity) {
    return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, opacity ? c[3] / 255.0 : 1};
}
glm::dvec4 fives(const TgaColour& c, bool opacity) {
    return {c[0] / 8 / 31.0, c[1] / 8 / 31.0, c[2] / 8 / 31.0, opacity ? c[3] / 128 : 1};
}
glm::dvec4 meant_by(const TgaColour& c, int bits, bool opacity) {
    return bits > 16 ? eights(c, opacity && bits == 32) : fives(c, opacity && bits == 16);
}

TEST(Tga, TrueColoursOfEveryDepthFromEveryCorner) {
    const Picture texels = picture_of(1);
    for (const auto& [bits, opacity] :
         {std::pair{15, 0}, {16, 0}, {16, 1}, {24, 0}, {32, 0}, {32, 8}, {24, 8}})
        each_way({.type = 2, .bits = bits, .opacity_bits = opacity},
                 [&, b = bits, o = opacity](const TgaKind& kind) {
                     for (const bool linear : {false, true})
                         expect_texels(tga_of(width, height, kind, texels), linear,
                                       [&](std::size_t i) { return meant_by(texels[i], b, o > 0); });
                 });
}

TEST(Tga, GreysWithAndWithoutOpacity) {
    const Picture texels = picture_of(2);
    for (const bool opacity : {false, true})
        each_way({.type = 3, .bits = opacity ? 16 : 8, .opacity_bits = opacity ? 8 : 0},
                 [&](const TgaKind& kind) {
                     expect_texels(tga_of(width, height, kind, texels), false, [&](std::size_t i) {
                         const double grey = texels[i][0] / 255.0;
                         return glm::dvec4(grey, grey, grey, opacity ? texels[i][3] / 255.0 : 1);
                     });
                 });
}

TEST(Tga, MapsOfEveryDepthWhoseFirstEntryHasANumber) {
    Picture texels = picture_of(3);
    const Picture map = picture_of(4);
    for (TgaColour& texel : texels)
        texel[0] = static_cast<std::uint8_t>(texel[0] % map.size());
    texels.front()[0] = 0;
    texels.back()[0] = static_cast<std::uint8_t>(map.size() - 1);
    for (const auto& [bits, first] : {std::pair{8, 0}, {8, 200}, {16, 0}, {16, 1000}})
        for (const auto& [entry_bits, opacity] :
             {std::pair{15, 0}, {16, 0}, {16, 1}, {24, 0}, {32, 0}, {32, 8}})
            each_way({.type = 1,
                      .bits = bits,
                      .opacity_bits = opacity,
                      .first = first,
                      .entry_bits = entry_bits,
                      .map = map},
                     [&, b = entry_bits, o = opacity](const TgaKind& kind) {
                         expect_texels(tga_of(width, height, kind, texels), false,
                                       [&](std::size_t i) { return meant_by(map[texels[i][0]], b, o > 0); });
                     });
}

TEST(Tga, WhatIsAroundTheTexelsIsPassedOver) {
    const Picture texels = picture_of(5);
    const std::string footer = std::string(8, '\0') + "TRUEVISION-XFILE." + std::string(1, '\0');
    for (const int type : {2, 10})
        expect_texels(tga_of(width, height,
                             {.type = type,
                              .entry_bits = 32,
                              .name = std::string(255, 'n'),
                              .map = {{1, 2, 3, 4}, {5, 6, 7, 8}},
                              .footer = footer},
                             texels),
                      false, [&](std::size_t i) { return eights(texels[i], false); });
}

TEST(Tga, IsTheSamePyramidAsPng) {
    const Picture texels = picture_of(6);
    std::vector<std::uint8_t> samples;
    for (const TgaColour& c : texels)
        samples.insert(samples.end(), c.begin(), c.end());
    const TexturePyramid png =
        decode_picture(png_of(width, height, {.colour = PNG_COLOR_TYPE_RGB_ALPHA}, samples), "p.png", false);
    const TexturePyramid tga = decode_picture(
        tga_of(width, height, {.type = 10, .bits = 32, .opacity_bits = 8}, texels), "p.tga", false);
    ASSERT_EQ(tga.levels.size(), png.levels.size());
    for (std::size_t i = 0; i < png.levels.size(); ++i) {
        EXPECT_EQ(tga.levels[i].texels, png.levels[i].texels) << i;
        EXPECT_EQ(tga.levels[i].opacity, png.levels[i].opacity) << i;
    }
}

TEST(Tga, LongRunsAndLargeSides) {
    const Picture texels(2000, TgaColour{10, 20, 30, 255});
    for (const auto& [w, h] : {std::pair{2000, 1}, {1, 2000}})
        for (const bool whole_rows : {false, true}) {
            const std::string bytes = tga_of(w, h, {.type = 10, .whole_rows = whole_rows}, texels);
            const TexturePyramid p = decode_picture(bytes, "p", false);
            EXPECT_EQ(p.levels.back().texels.front(),
                      colour_word({10 / 255.0, 20 / 255.0, 30 / 255.0}, false));
        }
}

TEST(Tga, HeightsAreTheFilesOwnRed) {
    const std::string bytes = tga_of(2, 1, {}, {{51, 9, 9, 0}, {204, 9, 9, 0}});
    const TexturePyramid p = decode_picture(bytes, "h", false, Texels::heights);
    EXPECT_EQ(p.least, 51.0F / 255);
    EXPECT_EQ(p.most, 204.0F / 255);
}

std::string message(const std::string& bytes, std::string_view name = "x.tga") {
    try {
        decode_picture(bytes, name, false);
    } catch (const UserError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
    return "";
}

/// Without a name that ends so, by a header that could be one; other formats by their first bytes, whatever
/// their names.
TEST(Tga, IsToldByNameOrHeader) {
    const std::string tga = tga_of(width, height, {.type = 10}, picture_of(7));
    for (const char* const name : {"x.tga", "x.TGA", "x", "x.png", "m.glb: image 0"})
        EXPECT_EQ(message(tga, name), "") << name;
    EXPECT_EQ(message(png_of(1, 1, {}, {1, 2, 3}), "x.tga"), "");
    EXPECT_EQ(message("GIF89a", "x.tga"),
              "x.tga: is a GIF picture; convert it to PNG, JPEG, TGA, OpenEXR or Radiance");
    EXPECT_EQ(message("", "x.tga"), "x.tga: is empty; give PNG, JPEG, TGA, OpenEXR or Radiance");
    EXPECT_EQ(message("nothing", "x.tga"),
              "x.tga: not a readable TGA picture (it is cut short); give another");
    const std::string icon("\0\0\1\0\1\0\x10\x10\0\0\1\0\x20\0\x68\4\0\0\x16\0\0\0", 22);
    EXPECT_EQ(message(icon, "x.ico"),
              "x.ico: is no picture that is read; give PNG, JPEG, TGA, OpenEXR or Radiance");
}

TEST(Tga, DamageIsOneClearLine) {
    const auto with = [](TgaKind kind, std::size_t at, int value) {
        std::string bytes = tga_of(2, 1, kind, {{0, 2, 3, 4}, {1, 2, 3, 4}});
        bytes.at(at) = static_cast<char>(value);
        return message(bytes);
    };
    const auto told = [](std::string_view cause) {
        return fmt::format("x.tga: not a readable TGA picture ({}); give another", cause);
    };
    const TgaKind mapped{.type = 1, .bits = 8, .first = 3, .map = {{1, 2, 3, 4}, {5, 6, 7, 8}}};
    EXPECT_EQ(with({}, 2, 0), told("it is of type 0, not 1, 2, 3, 9, 10 or 11"));
    EXPECT_EQ(with({}, 2, 32), told("it is of type 32, not 1, 2, 3, 9, 10 or 11"));
    EXPECT_EQ(with({}, 2, 1), told("its type is 1, but its map's 0"));
    EXPECT_EQ(with({}, 1, 2), told("its type is 2, but its map's 2"));
    EXPECT_EQ(with(mapped, 7, 8), told("its map has 8 bits an entry, not 15, 16, 24 or 32"));
    EXPECT_EQ(with(mapped, 16, 24), told("it has 24 bits a texel, not 8 or 16 to name an entry"));
    EXPECT_EQ(with({}, 16, 8), told("it has 8 bits a texel, not 15, 16, 24 or 32 of colour"));
    EXPECT_EQ(with({.type = 3, .bits = 8}, 16, 16),
              told("it has 16 bits a texel, 0 of opacity, not 8 of grey, or 8 of each"));
    EXPECT_EQ(with({.bits = 32}, 17, 3), told("it has 3 bits of opacity in 32"));
    EXPECT_EQ(with({}, 17, 64), told("its rows are interleaved"));
    EXPECT_EQ(with({}, 12, 0), "x.tga: 0 x 1 texels are none; give another picture");
    EXPECT_EQ(with({}, 13, 255), "x.tga: 65282 x 1 texels are too many; give at most 32768 x 32768");
    EXPECT_EQ(with(mapped, 3, 4), told("a texel names entry 3, but its map has 2 from 4 on"));
    EXPECT_EQ(with(mapped, 24, 5), told("a texel names entry 5, but its map has 2 from 3 on"));
    EXPECT_EQ(with({.type = 10}, 18, 130), told("a run goes on behind the last texel"));
    EXPECT_EQ(with({.type = 10}, 18, 2), told("it is cut short"));
}

/// Sizes that headers claim are refused before they are allocated: at most 128 texels are in a packet.
TEST(Tga, BombsAreRefused) {
    std::string bytes = tga_of(1, 1, {.type = 11, .bits = 8}, {{9, 9, 9, 9}});
    const auto with_size = [&](std::string_view size) {
        return message(bytes.replace(12, 4, size).substr(0, 18) + std::string(40000, '\xff'));
    };
    EXPECT_EQ(with_size(std::string_view("\x80\0\1\0", 4)), "");
    EXPECT_NE(with_size(std::string_view("\0\x40\0\x80", 4)).find("cannot be in"), std::string::npos);
    EXPECT_NE(with_size(std::string_view("\0\x08\0\x08", 4)).find("cut short"), std::string::npos);
    EXPECT_EQ(with_size(std::string_view("\0\x08\0\4", 4)), "");
}

TEST(Tga, EveryCutAndChangeIsReadOrRefused) {
    const Picture texels = picture_of(8), map = picture_of(9);
    Picture numbers = texels;
    for (TgaColour& texel : numbers)
        texel[0] = static_cast<std::uint8_t>(texel[0] % map.size());
    std::mt19937 random(10);
    for (const int type : {1, 2, 3, 9, 10, 11}) {
        const TgaKind kind{.type = type, .bits = type % 8 == 2 ? 24 : 8, .name = "n", .map = map};
        const std::string whole = tga_of(width, height, kind, type % 8 == 1 ? numbers : texels);
        ASSERT_EQ(message(whole), "");
        for (std::size_t size = 0; size < whole.size(); ++size)
            EXPECT_TRUE(message(whole.substr(0, size)).starts_with("x.tga: ")) << type << ' ' << size;
        for (int trial = 0; trial < 2000; ++trial) {
            std::string changed = whole;
            for (int n = 0; n <= trial % 3; ++n)
                changed[random() % (trial % 2 == 0 ? 18 : whole.size())] = static_cast<char>(random());
            const std::string said = message(changed);
            EXPECT_TRUE(said.empty() || said.starts_with("x.tga: ")) << said;
        }
    }
}

TEST(Tga, IsATextureOfScenes) {
    const TemporaryFolder folder;
    folder.file("s.tga", tga_of(1, 1, {}, {{255, 0, 0, 0}}));
    const Scene scene =
        build_scene(parse_scene_file("[[texture]]\nname = \"s\"\nfile = \"s.tga\"\n[[material]]\n"
                                     "name = \"m\"\nalbedo_map = \"s\"\n[[mesh]]\nshape = \"plane\"\n",
                                     "s.toml", folder.path()));
    ASSERT_EQ(scene.textures.size(), 1U);
    EXPECT_EQ(scene.textures[0].pyramid->levels[0].texels[0], colour_word({1, 0, 0}, false));
}

} // namespace
} // namespace razor
