// What the MD3 reader says to damaged files, and that no bytes whatever make it fail otherwise.
#include "razor/scene/models/md3_reader.h"

#include "razor/scene/error.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/sound_md3.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <string_view>

namespace razor {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int least_int = std::numeric_limits<int>::min(), largest_int = std::numeric_limits<int>::max();

/// Where the first surface of two frames and one tag begins.
constexpr std::size_t first_surface = 108 + 2 * (56 + 112);

std::string small_file() {
    return write_md3(two_surfaces(), 2);
}

/// The message of the UserError that parsing `bytes` as "m.md3" throws; empty if it loads.
std::string message_of(std::string_view bytes) {
    try {
        parse_md3(bytes, "m.md3");
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

void expect_part(const std::string& whole, std::string_view part) {
    EXPECT_NE(whole.find(part), std::string::npos) << whole << "\nlacks " << part;
}

/// The small file with one number changed.
std::string message_with(std::size_t at, std::int32_t number) {
    std::string bytes = small_file();
    put(bytes, at, number);
    return message_of(bytes);
}

TEST(Md3Damage, RefusesOtherFiles) {
    EXPECT_EQ(message_of("v 0 0 0\n"),
              "m.md3: begins with 'v 0 ', not with 'IDP3'; give a Quake III MD3 model");
    EXPECT_EQ(message_of(""), "m.md3: begins with '', not with 'IDP3'; give a Quake III MD3 model");
    EXPECT_EQ(message_of("IDP3"),
              "m.md3: has 4 bytes, but the header alone takes 108; the file is cut off or "
              "damaged, so export or copy it again");
    EXPECT_EQ(message_with(4, 14), "m.md3: is of MD3 version 14; export it as version 15");
    expect_part(message_with(4, 15 << 24), "is of MD3 version 251658240");
    try {
        parse_md3("IDP2\n", "a\nb.md3");
    } catch (const UserError& error) {
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    }
}

TEST(Md3Damage, DamagedTagsAreNamed) {
    const int size = static_cast<int>(small_file().size());
    expect_part(message_with(80, -1), "m.md3: states -1 tags from byte 220 on (at bytes 80 and 96); ");
    expect_part(message_with(96, least_int), "m.md3: states 1 tags from byte -2147483648 on");
    expect_part(
        message_with(80, largest_int),
        fmt::format("m.md3: 2147483647 tags of 2 frames from byte 220 on do not fit into its {} bytes; ",
                    size));
    expect_part(message_with(96, size - 2 * 112 + 1), "m.md3: 1 tags of 2 frames from byte ");
    expect_part(message_with(96, largest_int), "m.md3: 1 tags of 2 frames from byte 2147483647 on");
    expect_part(message_with(220 + 112, 'X'),
                "m.md3: the tag 'UUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUUU' is called "
                "'X' in frame 1 (at byte 332); ");
    EXPECT_EQ(message_with(80, 0), ""); // none: wherever they begin
}

TEST(Md3Damage, DamagedHeadersAreNamed) {
    const std::size_t size = small_file().size();
    EXPECT_EQ(message_with(76, 0), "m.md3: has no frames; export it with one at least");
    EXPECT_EQ(message_with(84, 0), "m.md3: has no surfaces; export it with one at least");
    expect_part(message_with(76, -1), "m.md3: states -1 frames (at byte 76); ");
    expect_part(message_with(84, least_int), "m.md3: states -2147483648 surfaces (at byte 84); ");
    expect_part(message_with(100, -1), "m.md3: surfaces begin at byte -1; ");
    expect_part(message_with(100, largest_int), "surface 1 of 2 at byte 2147483647: its header does not fit");
    expect_part(message_with(100, 107), "surface 1 of 2 at byte 107: begins with '");
    expect_part(message_with(104, static_cast<int>(size) + 1),
                fmt::format("m.md3: should end at byte {}, but has {} bytes; ", size + 1, size));
    expect_part(message_with(104, -1), "should end at byte -1");
    expect_part(
        message_with(84, 3),
        fmt::format("m.md3: surface 3 of 3 at byte {}: its header does not fit into the file's {} bytes; ",
                    size, size));
    expect_part(message_with(84, largest_int), "surface 3 of 2147483647");
    expect_part(message_with(76, 3),
                "has 2 frames, but the model 3; export all surfaces with the same frames");
    expect_part(message_with(76, largest_int), "has 2 frames, but the model 2147483647");
}

TEST(Md3Damage, DamagedSurfacesAreNamed) {
    const std::string label = fmt::format("m.md3: surface 1 of 2 ('left', at byte {}): ", first_surface);
    const auto message = [](std::size_t field, int number) {
        return message_with(first_surface + field, number);
    };
    expect_part(message(0, 0),
                fmt::format("surface 1 of 2 at byte {}: begins with '\\x00\\x00\\x00\\x00', not "
                            "with 'IDP3'; the file is cut off",
                            first_surface));
    expect_part(message(72, 1), label + "has 1 frames, but the model 2; ");
    for (const auto& [field, what] : std::map<std::size_t, std::string>{{72, "frames"},
                                                                        {76, "shaders"},
                                                                        {80, "vertices"},
                                                                        {84, "triangles"},
                                                                        {88, "triangles"},
                                                                        {92, "shaders"},
                                                                        {96, "texture coordinates"},
                                                                        {100, "points"},
                                                                        {104, "size"}}) {
        for (const int number : {-1, least_int}) {
            expect_part(message(field, number), label + fmt::format("states {} for its {} (at byte {}); ",
                                                                    number, what, first_surface + field));
        }
        EXPECT_NE(message(field, largest_int), "") << what;
    }
    EXPECT_EQ(message(96, 1 << 30),
              label +
                  fmt::format("7 texture coordinates of 8 bytes from its byte 1073741824 on do not fit into "
                              "its {} bytes; the file is cut off or damaged, so export or copy it again",
                              write_surface(two_surfaces()[0]).size()));
    expect_part(message(84, 1 << 28),
                label + "268435456 triangles of 12 bytes from its byte 108 on do not fit");
    expect_part(message(80, largest_int), label + "2147483647 texture coordinates");
    expect_part(message(76, 1 << 25), label + "33554432 shaders of 68 bytes from its byte 144 on do not fit");
    expect_part(message(104, 107), label + "states a size of 107 bytes, where 108 to ");
    expect_part(message(104, 0), label + "states a size of 0 bytes");
}

/// The last record that fits, and one byte further, of every table.
TEST(Md3Damage, TablesEndWithTheirSurface) {
    const auto size = static_cast<int>(write_surface(two_surfaces()[0]).size());
    for (const auto& [field, bytes] :
         std::map<std::size_t, int>{{88, 3 * 12}, {92, 68}, {96, 7 * 8}, {100, 2 * 7 * 8}}) {
        expect_part(message_with(first_surface + field, size - bytes + 1), "do not fit");
        EXPECT_EQ(message_with(first_surface + field, size - bytes).find("do not fit"), std::string::npos);
    }
}

TEST(Md3Damage, NoShadersAreNowhere) {
    std::string bytes = small_file();
    put(bytes, first_surface + 76, 0);
    for (const int at : {-1, largest_int}) {
        put(bytes, first_surface + 92, at);
        EXPECT_EQ(message_of(bytes), "");
    }
}

/// Products of them are beyond 32 bits.
TEST(Md3Damage, LargestCountsAreRefused) {
    std::string bytes = small_file();
    put(bytes, 76, largest_int);
    put(bytes, first_surface + 72, largest_int);
    expect_part(message_of(bytes), "15032385529 points of 8 bytes");
    put(bytes, first_surface + 80, largest_int);
    put(bytes, first_surface + 84, 0);
    EXPECT_NE(message_of(bytes), "");
    // Without vertices nothing bounds the frames but that no triangle is left.
    std::vector<Md3SurfaceData> empty{{"none", {}, {}, {{}}}};
    bytes = write_md3(empty, 1);
    put(bytes, 76, largest_int);
    put(bytes, 108 + 56 + 112 + 72, largest_int);
    EXPECT_EQ(message_of(bytes),
              "m.md3: none of its 0 triangles has three distinct corners; give a model with a surface");
}

TEST(Md3Damage, WrongIndicesAreNamed) {
    const std::string label = fmt::format("m.md3: surface 1 of 2 ('left', at byte {}): ", first_surface);
    const std::size_t triangle = first_surface + 108 + 12;
    for (const int vertex : {7, -1, least_int, largest_int}) {
        EXPECT_EQ(message_with(triangle + 8, vertex),
                  label +
                      fmt::format("triangle 1 (counted from 0, at byte {}) names vertex {}, but the surface "
                                  "has 7; mend the index",
                                  triangle, vertex));
    }
    EXPECT_EQ(message_with(triangle + 8, 6), "");
}

TEST(Md3Damage, TextureCoordinatesAreFinite) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    for (const float bad : {infinity, -infinity, std::nanf("")}) {
        for (const std::size_t i : {0U, 1U}) {
            surfaces[1].texcoords[2] = {0, 0};
            surfaces[1].texcoords[2].at(i) = bad;
            expect_part(message_of(write_md3(surfaces, 2)),
                        "texture coordinate of vertex 2 (counted from 0, at");
        }
    }
    surfaces[1].texcoords[2] = {3e38F, -3e38F};
    EXPECT_TRUE(sound(parse_md3(write_md3(surfaces, 2), "m.md3")));
}

TEST(Md3Damage, ModelsWithoutATriangleAreRefused) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    surfaces.pop_back();
    surfaces[0].triangles = {{0, 4, 1}, {3, 2, 6}, {5, 1, 2}, {1, 1, 3}};
    EXPECT_EQ(message_of(write_md3(surfaces, 2)),
              "m.md3: none of its 4 triangles has three distinct corners; give a model with a surface");
}

TEST(Md3Damage, EveryTruncationIsRefused) {
    const std::string bytes = small_file();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const std::string cut(bytes, 0, length); // of its own, so that a sanitizer sees what lies behind
        const std::string message = message_of(cut);
        EXPECT_TRUE(message.starts_with("m.md3: ") && message.find('\n') == std::string::npos) << length;
        std::string mended = cut; // the header no longer gives it away
        if (length >= 108) {
            put(mended, 104, static_cast<int>(length));
            EXPECT_NE(message_of(mended), "") << length;
        }
    }
}

TEST(Md3Damage, AnyBytesGiveASoundModelOrAMessage) {
    const std::string bytes = small_file();
    std::mt19937 random(20240229);
    const std::array<int, 10> numbers{0, 1, -1, 2, 7, 8, 108, 1 << 16, least_int, largest_int};
    int loaded = 0;
    for (int round = 0; round < 50000; ++round) {
        std::string changed = bytes;
        for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
            // Every second in a header, where counts and offsets are.
            const std::size_t begin = random() % 2 == 0 ? first_surface : 0;
            const std::size_t at = begin + random() % (random() % 2 == 0 ? 216 : bytes.size() - begin - 4);
            if (random() % 2 == 0) {
                changed[at] = static_cast<char>(random() & 0xFF);
            } else {
                put(changed, at / 4 * 4, numbers.at(random() % numbers.size()));
            }
        }
        if (random() % 8 == 0) {
            changed.resize(random() % changed.size());
        }
        try {
            EXPECT_TRUE(sound(parse_md3(changed, "m.md3"))) << round;
            ++loaded;
        } catch (const UserError& error) {
            const std::string_view message = error.what();
            EXPECT_TRUE(message.starts_with("m.md3: ") && message.find_first_of("\n\r") == message.npos)
                << message;
        }
    }
    EXPECT_GT(loaded, 1000);
    EXPECT_LT(loaded, 49000);
}

} // namespace
} // namespace razor
