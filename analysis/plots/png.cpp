#include "analysis/plots/png.h"

#include <fmt/format.h>
#include <png.h>

#include <stdexcept>

namespace analysis {

std::string png_bytes(const Pixels& pixels) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(pixels.width);
    image.height = static_cast<png_uint_32>(pixels.height);
    image.format = PNG_FORMAT_RGB;
    std::string out;
    for (const bool write : {false, true}) { // asks for the size first
        png_alloc_size_t size = out.size();
        if (png_image_write_to_memory(&image, write ? out.data() : nullptr, &size, 0, pixels.rgb.data(), 0,
                                      nullptr) == 0) {
            const std::string why = image.message;
            png_image_free(&image);
            throw std::runtime_error(fmt::format("a PNG picture of {} x {} pixels cannot be made: {}",
                                                 pixels.width, pixels.height, why));
        }
        out.resize(size);
    }
    return out;
}

std::string data_uri(std::string_view png) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out = "data:image/png;base64,";
    for (std::size_t i = 0; i < png.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8U | (i + k < png.size() ? static_cast<std::uint8_t>(png[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= png.size() ? digits[bits >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
}

} // namespace analysis
