// libFuzzer: any bytes are a pyramid as texture.h says or one clear line, never a crash. Begins with a small
// picture of each kind.
#include "razor/scene/error.h"
#include "razor/scene/textures/picture.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/radiance_writer.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using Bytes = std::vector<std::uint8_t>;

const std::array<std::string, 9> seeds{
    razor::png_of(5, 3, {}, Bytes(45, 99)),
    razor::png_of(9, 9, {.colour = PNG_COLOR_TYPE_RGB_ALPHA, .interlaced = true}, Bytes(324, 7)),
    razor::png_of(8, 2, {.depth = 2, .colour = PNG_COLOR_TYPE_PALETTE, .palette = {{1, 2, 3}, {4, 5, 6}}},
                  Bytes(4, 17)),
    razor::jpeg_of(9, 10, 3, Bytes(270, 50)),
    razor::jpeg_of(16, 8, 3, Bytes(384, 50), true),
    razor::jpeg_of(8, 8, 1, Bytes(64, 50)),
    razor::exr_of(4, 3, {{"R", std::vector<float>(12, 1)}, {"A", std::vector<float>(12, 0.5F)}}),
    razor::radiance_of(9, 3, razor::ramp_of_pixels(27), razor::RadianceRuns::each),
    razor::radiance_of(5, 2, razor::ramp_of_pixels(10), razor::RadianceRuns::old),
};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

void check(const razor::TexturePyramid& pyramid) {
    require(!pyramid.levels.empty() && pyramid.levels.size() <= std::size_t{razor::most_texture_levels});
    require(pyramid.levels.back().width == 1 && pyramid.levels.back().height == 1);
    for (const razor::TextureLevel& level : pyramid.levels) {
        const auto tiles = [](int side) { return static_cast<std::size_t>(side + 3) / 4; };
        require(level.texels.size() == 16 * tiles(level.width) * tiles(level.height));
        require(level.opacity.empty() || level.opacity.size() == level.texels.size());
    }
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    if (size <= 1 || seed % 512 == 0) {
        const std::string& bytes = seeds[seed / 512 % seeds.size()];
        size = std::min(bytes.size(), max_size);
        std::memcpy(data, bytes.data(), size);
    }
    return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 1100) // which might be of millions of texels
        return -1;
    try {
        check(razor::decode_picture({reinterpret_cast<const char*>(data), size}, "fuzz", size % 2 == 0));
    } catch (const razor::UserError& error) {
        require(std::string_view(error.what()).starts_with("fuzz:"));
        require(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
    }
    return 0;
}
