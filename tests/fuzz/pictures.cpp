// Pictures: any bytes are a pyramid as texture.h says or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/textures/picture.h"
#include "tests/fuzz/target.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/radiance_writer.h"
#include "tests/scene/tga_writer.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Colours = std::vector<razor::TgaColour>;

void check(const razor::TexturePyramid& pyramid) {
    fuzz::require(!pyramid.levels.empty() &&
                  pyramid.levels.size() <= std::size_t{razor::most_texture_levels});
    fuzz::require(pyramid.levels.back().width == 1 && pyramid.levels.back().height == 1);
    for (const razor::TextureLevel& level : pyramid.levels) {
        const auto tiles = [](int side) { return static_cast<std::size_t>(side + 3) / 4; };
        fuzz::require(level.texels.size() == 16 * tiles(level.width) * tiles(level.height));
        fuzz::require(level.opacity.empty() || level.opacity.size() == level.texels.size());
    }
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
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
        razor::tga_of(5, 3, {.bits = 32, .opacity_bits = 8, .from_right = true}, Colours(15, {1, 2, 3, 4})),
        razor::tga_of(5, 3, {.type = 10, .bits = 16, .opacity_bits = 1, .name = "n"},
                      Colours(15, {9, 8, 7, 6})),
        razor::tga_of(4, 2, {.type = 1, .bits = 8, .first = 7, .map = Colours(2)}, Colours(8, {1, 0, 0, 0})),
        razor::tga_of(4, 2, {.type = 9, .bits = 16, .entry_bits = 15, .map = Colours(3)},
                      Colours(8, {2, 0, 0, 0})),
        razor::tga_of(9, 2, {.type = 3, .bits = 16, .opacity_bits = 8, .from_top = true},
                      Colours(18, {5, 5, 5, 5})),
        razor::tga_of(9, 2, {.type = 11, .bits = 8, .whole_rows = false}, Colours(18)),
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    if (bytes.size() > 1100) // which might be of millions of texels
        return false;
    try {
        check(
            razor::decode_picture(bytes, bytes.size() % 3 == 0 ? "fuzz.tga" : "fuzz", bytes.size() % 2 == 0));
    } catch (const razor::UserError& error) {
        require_line(error.what());
    }
    return true;
}
