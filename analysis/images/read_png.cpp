#include "analysis/images/image_file.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cstdio>
#include <memory>
#include <utility>

namespace analysis {
namespace {

/// Rows of samples as stored: palettes and packed bits expanded, 16-bit samples big-endian.
struct Decoded {
    png_uint_32 width = 0, height = 0;
    int channels = 0, depth = 0;
    png_bytepp rows = nullptr; // owned by the png_struct
};

void keep_error(png_structp png, png_const_charp message) {
    *static_cast<std::array<char, 200>*>(png_get_error_ptr(png)) = {};
    std::snprintf(static_cast<std::array<char, 200>*>(png_get_error_ptr(png))->data(), 200, "%s", message);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// Only trivially destructible locals here: errors jump.
bool decode(png_structp png, png_infop info, std::FILE* file, Decoded* out) {
    if (setjmp(png_jmpbuf(png)) != 0) { // NOLINT(cert-err52-cpp)
        return false;
    }
    png_init_io(png, file);
    png_set_user_limits(png, 65536, 65536);
    png_read_png(png, info, PNG_TRANSFORM_EXPAND, nullptr);
    out->width = png_get_image_width(png, info);
    out->height = png_get_image_height(png, info);
    out->channels = png_get_channels(png, info);
    out->depth = png_get_bit_depth(png, info);
    out->rows = png_get_rows(png, info);
    return true;
}

ImageFile image_of(const Decoded& decoded) {
    ImageFile image{static_cast<int>(decoded.width), static_cast<int>(decoded.height), {}};
    constexpr std::array<std::array<const char*, 4>, 4> names{
        {{"Y", "", "", ""}, {"Y", "A", "", ""}, {"R", "G", "B", ""}, {"R", "G", "B", "A"}}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    for (std::size_t c = 0; c < channels; ++c) {
        Channel channel{
            names[channels - 1][c], decoded.depth == 16 ? Channel::Kind::uint16 : Channel::Kind::uint8, {}};
        for (png_uint_32 y = 0; y < decoded.height; ++y) {
            for (std::size_t x = 0; x < decoded.width; ++x) {
                const std::size_t at = x * channels + c;
                const png_bytep row = decoded.rows[y];
                channel.bits.push_back(decoded.depth == 16 ? row[2 * at] * 256U + row[2 * at + 1]
                                                           : std::uint32_t{row[at]});
            }
        }
        image.channels.push_back(std::move(channel));
    }
    return image;
}

} // namespace

ImageFile read_png(const std::filesystem::path& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) {
        throw ImageError(fmt::format("{}: cannot be opened", path.string()));
    }
    std::array<char, 200> error{};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, keep_error, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    Decoded decoded;
    ImageFile image;
    const bool done = info != nullptr && decode(png, info, file.get(), &decoded);
    try {
        if (done) {
            image = image_of(decoded);
        }
    } catch (...) {
        png_destroy_read_struct(&png, &info, nullptr);
        throw;
    }
    png_destroy_read_struct(&png, &info, nullptr);
    if (!done) {
        throw ImageError(fmt::format("{}: not a readable PNG picture ({})", path.string(), error.data()));
    }
    return image;
}

} // namespace analysis
