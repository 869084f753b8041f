// Pictures through their files and back; files that are whole or not there.
#include "razor/image/exr.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/image/png.h"
#include "razor/scene/error.h"
#include "tests/scene/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tuple>
#include <unistd.h>

namespace razor {
namespace {

Film noise(int width, int height) {
    Film film = make_film(width, height);
    std::uint32_t state = 1;
    for (Plane& plane : film.planes) {
        for (float& value : plane.values) {
            state = state * 1664525U + 1013904223U;
            value = static_cast<float>(state >> 8) * 0x1p-23F;
        }
    }
    return film;
}

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// As OpenEXR's own reader sees it: layers by name, windows, what the camera was.
TEST(Exr, SaysWhatThePictureIs) {
    const TemporaryFolder folder;
    Film film = noise(9, 5);
    film.window = PictureWindow{30, 11, 64, 48};
    film.camera.emplace();
    for (std::size_t i = 0; i < 16; ++i) {
        film.camera->world_to_camera[i] = static_cast<float>(i) + 0.25F;
        film.camera->world_to_ndc[i] = 20 - static_cast<float>(i);
    }
    film.camera->screen_width = 1.5F;
    write_exr(folder / "a.exr", film);
    {
        Imf::InputFile file((folder / "a.exr").c_str());
        const Imf::Header& header = file.header();
        EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {63, 47}));
        EXPECT_EQ(header.dataWindow(), Imath::Box2i({30, 11}, {38, 15}));
        EXPECT_EQ(header.pixelAspectRatio(), 1);
        EXPECT_EQ(header.screenWindowWidth(), 1.5F);
        EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(0, 0));
        EXPECT_EQ(Imf::worldToCamera(header)[0][1], 1.25F);
        EXPECT_EQ(Imf::worldToNDC(header)[3][3], 5);
        EXPECT_EQ(Imf::chromaticities(header).green, Imath::V2f(0.3F, 0.6F));
        EXPECT_FALSE(Imf::hasCapDate(header));
        std::set<std::string> layers;
        header.channels().layers(layers);
        EXPECT_EQ(layers, (std::set<std::string>{"albedo", "depth", "normal"}));
        Imf::ChannelList::ConstIterator first, end;
        header.channels().channelsInLayer("normal", first, end);
        std::vector<std::string> channels;
        for (; first != end; ++first)
            channels.emplace_back(first.name());
        EXPECT_EQ(channels, (std::vector<std::string>{"normal.X", "normal.Y", "normal.Z"}));
        for (const char* beauty : {"R", "G", "B"})
            EXPECT_NE(header.channels().findChannel(beauty), nullptr);
    }
    const Film again = read_exr(folder / "a.exr");
    EXPECT_EQ(again.window, film.window);
    EXPECT_EQ(again.camera, film.camera);
    EXPECT_EQ(again.find("depth.Z")->values, film.find("depth.Z")->values);
    write_exr(folder / "b.exr", again);
    EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
    write_exr(folder / "whole.exr", noise(9, 5));
    EXPECT_FALSE(read_exr(folder / "whole.exr").window.has_value());
    EXPECT_FALSE(read_exr(folder / "whole.exr").camera.has_value());
}

TEST(Exr, KeepsEveryBit) {
    const TemporaryFolder folder;
    Film film = noise(37, 21);
    auto& red = film.find("R")->values;
    red[0] = std::numeric_limits<float>::infinity();
    red[1] = -0.0F;
    red[2] = std::numeric_limits<float>::denorm_min();
    red[3] = std::bit_cast<float>(0x7fc12345U);
    write_exr(folder / "a.exr", film, {{"razor.config", "x = 1\n\"quoted\""}, {"razor.version", "razor 0"}});
    ImageAttributes attributes;
    const Film again = read_exr(folder / "a.exr", &attributes);
    EXPECT_EQ(again.width, 37);
    EXPECT_EQ(again.height, 21);
    ASSERT_EQ(again.planes.size(), film.planes.size());
    for (const Plane& plane : film.planes) {
        const Plane* const read = again.find(plane.name);
        ASSERT_NE(read, nullptr) << plane.name;
        EXPECT_EQ(std::memcmp(read->values.data(), plane.values.data(), 4 * plane.values.size()), 0)
            << plane.name;
    }
    const auto has = [&](const std::string& name, const std::string& value) {
        return std::find(attributes.begin(), attributes.end(), std::pair(name, value)) != attributes.end();
    };
    EXPECT_TRUE(has("razor.config", "x = 1\n\"quoted\""));
    EXPECT_TRUE(has("razor.version", "razor 0"));
    EXPECT_EQ(folder.count(), 1U);
}

TEST(Exr, RefusesWhatIsNone) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", noise(40, 40));
    std::ifstream file(folder / "a.exr", std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(file)), {});
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{3}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
        const auto cut = folder.file("cut.exr", whole.substr(0, size));
        const std::string message = message_of([&] { read_exr(cut); });
        EXPECT_NE(message.find("not a readable OpenEXR picture"), std::string::npos) << size << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    // More pixels than so few bytes can hold, of which nothing is allocated.
    write_exr(folder / "b.exr", noise(8, 8));
    std::ifstream small(folder / "b.exr", std::ios::binary);
    std::string large((std::istreambuf_iterator<char>(small)), {});
    const std::size_t window = large.find("dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
    const std::int32_t corner = 19999;
    std::memcpy(&large[window + 8], &corner, 4);
    std::memcpy(&large[window + 12], &corner, 4);
    const std::string message = message_of([&, file = folder.file("large.exr", large)] { read_exr(file); });
    EXPECT_NE(
        message.find(fmt::format("large.exr: 20000 x 20000 pixels cannot be in {} bytes", large.size())),
        std::string::npos)
        << message;
    EXPECT_THROW(read_exr(folder / "none.exr"), UserError);
    EXPECT_THROW(read_exr(folder.path()), UserError);
}

TEST(Png, EncodesSrgb) {
    EXPECT_EQ(to_srgb8(0.0F), 0);
    EXPECT_EQ(to_srgb8(-1.0F), 0);
    EXPECT_EQ(to_srgb8(std::nanf("")), 0);
    EXPECT_EQ(to_srgb8(1.0F), 255);
    EXPECT_EQ(to_srgb8(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(to_srgb8(0.5F), 188);
    EXPECT_EQ(to_srgb8(0.2158605F), 128); // 128 / 255 decoded
    EXPECT_EQ(to_srgb8(0.001F), 3);       // on the straight piece: 12.92 * 0.255
    // Decoding each of the 256 values by the standard's inverse and encoding again changes none.
    for (int value = 0; value < 256; ++value) {
        const double s = value / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        EXPECT_EQ(to_srgb8(static_cast<float>(linear)), value);
    }
}

TEST(Png, RoundTrip) {
    const TemporaryFolder folder;
    const Film film = noise(19, 7);
    write_png(folder / "a.png", film, {{"razor.config", std::string(5000, 'x') + "\xc3\xa9"}},
              {.exposure = -1, .curve = ToneCurve::srgb});
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()), 0);
    EXPECT_EQ(image.width, 19U);
    EXPECT_EQ(image.height, 7U);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        EXPECT_EQ(pixels[3 * i], to_srgb8(0.5F * film.find("R")->values[i]));
        EXPECT_EQ(pixels[3 * i + 1], to_srgb8(0.5F * film.find("G")->values[i]));
        EXPECT_EQ(pixels[3 * i + 2], to_srgb8(0.5F * film.find("B")->values[i]));
    }
    EXPECT_EQ(folder.count(), 1U);
}

TEST(Output, IsRefusedBeforeRendering) {
    const TemporaryFolder folder;
    const auto refused = [&](const std::filesystem::path& path, std::string_view cause) {
        const std::string message = message_of([&] { check_output(path); });
        EXPECT_NE(message.find(cause), std::string::npos) << path << message;
    };
    refused(folder / "a.jpg", "end the name in .exr or .png");
    refused(folder / "a", "end the name in .exr or .png");
    refused("", "end the name in .exr or .png");
    refused(folder / "none" / "a.exr", "no folder");
    std::filesystem::create_directory(folder / "d.exr");
    refused(folder / "d.exr", "is a directory");
    folder.file("f", "x");
    refused(folder / "f" / "a.exr", "no folder");
    check_output(folder / "a.EXR");
    check_output(folder.file("b.png", "kept"));
    EXPECT_EQ(folder.count(), 3U) << "checking leaves nothing behind";
    EXPECT_EQ(std::filesystem::file_size(folder / "b.png"), 4U);
    if (::geteuid() != 0) {
        std::filesystem::permissions(folder.path(),
                                     std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
        refused(folder / "c.exr", "cannot be written");
        std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
    }
}

TEST(Output, FailureLeavesTheOldFile) {
    const TemporaryFolder folder;
    // A small file fails when what is buffered goes out, which is where OpenEXR seeks in a destructor.
    for (const auto& [name, side, most] : {std::tuple<const char*, int, rlim_t>{"a.exr", 200, 10000},
                                           {"a.png", 200, 10000},
                                           {"b.exr", 4, 100},
                                           {"b.png", 4, 50}}) {
        const Film film = noise(side, side);
        folder.file(name, "old");
        rlimit before{};
        ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{most, before.rlim_max};
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
        const std::string message = message_of([&, file = folder / name] { write_image(file, film, {}); });
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
        std::signal(SIGXFSZ, handler);
        EXPECT_NE(message.find("cannot be written"), std::string::npos) << name << message;
        EXPECT_EQ(std::filesystem::file_size(folder / name), 3U);
    }
    EXPECT_EQ(folder.count(), 4U) << "the temporary file is removed";
}

TEST(Output, PutsNoFileInThePlaceOfADevice) {
    const TemporaryFolder folder;
    const std::string pipe = folder.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(write_text_file(pipe, "text"), UserError);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(Output, WritesThroughLinks) {
    const TemporaryFolder folder;
    folder.file("real.txt", "old");
    std::filesystem::create_symlink("real.txt", folder / "link.txt");
    write_text_file(folder / "link.txt", "newer");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
    EXPECT_EQ(std::filesystem::file_size(folder / "real.txt"), 5U);
}

TEST(Tone, FilmCurveKeepsGreysGreyAndNeverFalls) {
    const Tone aces{.exposure = 0, .curve = ToneCurve::aces};
    float before = -1;
    for (float light = 0; light < 1e6F; light = light * 1.1F + 0.001F) {
        const glm::vec3 colour = display_colour(glm::vec3(light), aces);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(colour[c], 0);
            EXPECT_LE(colour[c], 1);
            EXPECT_NEAR(colour[c], colour[1], 2e-4F) << light;
        }
        EXPECT_GE(colour.y, before);
        before = colour.y;
    }
    EXPECT_EQ(before, 1);
    EXPECT_NEAR(display_colour(glm::vec3(0.18F), aces).y, 0.1056F, 0.002F); // of the fit, by hand
    EXPECT_LT(display_colour(glm::vec3(0), aces).y, 1e-4F);
    // What is bright and coloured turns white, not into another colour cut off.
    const glm::vec3 red = display_colour({50, 1, 0.5F}, aces);
    EXPECT_GT(red.y, 0.5F);
    EXPECT_EQ(red.x, 1);
}

TEST(Tone, ExposureIsInStops) {
    EXPECT_EQ(display_colour({0.1F, 0.2F, 0.3F}, {.exposure = 2, .curve = ToneCurve::srgb}),
              glm::vec3(0.4F, 0.8F, 1.2F));
    const glm::vec3 a = display_colour(glm::vec3(0.5F), {.exposure = -3, .curve = ToneCurve::aces});
    const glm::vec3 b = display_colour(glm::vec3(0.0625F), {.exposure = 0, .curve = ToneCurve::aces});
    EXPECT_EQ(a, b);
}

// Which has a link, but no name of its own.
TEST(Image, PipesAreNoOutputs) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const std::string name = fmt::format("/proc/self/fd/{}", ends[1]);
    try {
        check_writable(name);
        ADD_FAILURE() << name;
    } catch (const UserError& e) {
        EXPECT_EQ(std::string(e.what()), name + ": is not a regular file; choose another name");
    }
    ::close(ends[0]);
    ::close(ends[1]);
}

// What is printed afterwards would be lost with the file whose place is taken.
TEST(Image, FilesOfStandardOutputAreNoOutputs) {
    const TemporaryFolder folder;
    const std::string name = folder / "standard.txt";
    std::fflush(stdout);
    const int before = ::dup(STDOUT_FILENO);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666); // NOLINT: as of POSIX
    ASSERT_GE(file, 0);
    ::dup2(file, STDOUT_FILENO);
    ::close(file);
    std::string told;
    for (const std::string& output : {name, std::string("/dev/stdout")}) {
        try {
            write_text_file(output, "some");
        } catch (const UserError& e) {
            told += e.what();
            told += "\n";
        }
    }
    ::dup2(before, STDOUT_FILENO);
    ::close(before);
    const std::string why = ": is where standard output or error goes; name another file\n";
    EXPECT_EQ(told, name + why + "/dev/stdout" + why);
    EXPECT_TRUE(std::filesystem::is_symlink("/dev/stdout"));
}

// Whatever ends the program meanwhile; and names may be as long as the file system has them.
TEST(Image, NothingIsSeenOfFilesBeforeTheyAreWhole) {
    const TemporaryFolder folder;
    const std::filesystem::path name = folder / std::string(255, 'x');
    for (std::size_t turn = 0; turn < 2; ++turn) {
        OutputFile first(name);
        OutputFile second(name);
        first.write("first", 5);
        second.write("second", 6);
        const int unnamed = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0666); // NOLINT: as of POSIX
        if (unnamed >= 0) {
            ::close(unnamed);
            EXPECT_EQ(folder.count(), turn);
        }
        first.commit();
        second.commit();
        EXPECT_EQ(folder.count(), 1U);
        EXPECT_EQ(std::filesystem::file_size(name), 6U);
    }
}

} // namespace
} // namespace razor
