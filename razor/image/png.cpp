#include "razor/image/png.h"

#include "razor/image/output_file.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <memory>

namespace razor {
namespace {

/// What libpng's C callbacks work on.
struct Encoder {
    std::vector<std::uint8_t> bytes;
    std::string error;
};

/// libpng is C and must not be unwound: an allocation failure becomes its own error.
void append(png_structp png, png_bytep data, std::size_t count) {
    auto& encoder = *static_cast<Encoder*>(png_get_io_ptr(png));
    bool failed = false;
    try {
        encoder.bytes.insert(encoder.bytes.end(), data, data + count);
    } catch (...) {
        failed = true;
    }
    if (failed) {
        png_error(png, "out of memory");
    }
}

void keep_error(png_structp png, png_const_charp message) {
    static_cast<Encoder*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// Only trivially destructible locals here: errors jump.
bool encode(png_structp png, png_infop info, int width, int height, png_bytepp rows, png_textp texts,
            int text_count) {
    if (setjmp(png_jmpbuf(png)) != 0) { // NOLINT(cert-err52-cpp)
        return false;
    }
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (text_count > 0) {
        png_set_text(png, info, texts, text_count);
    }
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    return true;
}

} // namespace

std::uint8_t to_srgb8(float linear) {
    if (!(linear > 0)) {
        return 0;
    }
    if (linear >= 1) {
        return 255;
    }
    const double x = linear;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(255.0 * encoded + 0.5);
}

void write_png(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes,
               const Tone& tone) {
    OutputFile file(path); // refuses first what cannot be written
    const std::size_t width = static_cast<std::size_t>(film.width);
    std::vector<std::uint8_t> pixels(3 * film.pixel_count());
    const std::array<const Plane*, 3> planes{film.find("R"), film.find("G"), film.find("B")};
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        glm::vec3 light(0);
        for (std::size_t c = 0; c < 3; ++c) {
            light[static_cast<int>(c)] = planes[c] != nullptr ? static_cast<float>(planes[c]->at(i)) : 0.0F;
        }
        const glm::vec3 colour = display_colour(light, tone);
        for (std::size_t c = 0; c < 3; ++c) {
            pixels[3 * i + c] = to_srgb8(colour[static_cast<int>(c)]);
        }
    }
    std::vector<png_bytep> rows;
    for (int y = 0; y < film.height; ++y) {
        rows.push_back(pixels.data() + 3 * width * static_cast<std::size_t>(y));
    }
    std::vector<png_text> texts;
    for (const auto& [name, value] : attributes) {
        png_text text{};
        text.compression = PNG_ITXT_COMPRESSION_zTXt;
        text.key = const_cast<char*>(name.c_str());   // NOLINT(cppcoreguidelines-pro-type-const-cast)
        text.text = const_cast<char*>(value.c_str()); // NOLINT(cppcoreguidelines-pro-type-const-cast)
        text.itxt_length = value.size();
        texts.push_back(text);
    }
    Encoder encoder;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, keep_error, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    bool done = false;
    if (info != nullptr) {
        png_set_write_fn(png, &encoder, append, nullptr);
        done = encode(png, info, film.width, film.height, rows.data(), texts.data(),
                      static_cast<int>(texts.size()));
    }
    png_destroy_write_struct(&png, &info);
    if (!done) {
        throw UserError(fmt::format("{}: cannot be encoded as PNG ({}); choose another size",
                                    printable(path.string(), 1000), printable(encoder.error, 200)));
    }
    file.write(encoder.bytes.data(), encoder.bytes.size());
    file.commit();
}

} // namespace razor
