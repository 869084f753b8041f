#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/srgb.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <memory>

namespace razor {
namespace {

/// What libpng's C callbacks work on.
struct Source {
    std::string_view bytes; // not read yet
    char error[200] = {};
};

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.bytes.size())
        png_error(png, "it is cut short");
    std::memcpy(to, source.bytes.data(), count);
    source.bytes.remove_prefix(count);
}

void keep_error(png_structp png, png_const_charp message) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    std::strncpy(source.error, message, sizeof source.error - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

// Errors jump: only trivially destructible locals in these four.

bool read_header(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png)) != 0) // NOLINT(cert-err52-cpp)
        return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // check_picture_size() has others
    png_read_info(png, info);
    return true;
}

/// Palettes as colours, keys as opacity, at least 8 bits a sample. Interlaced ones become whole rows.
bool begin_rows(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png)) != 0) // NOLINT(cert-err52-cpp)
        return false;
    png_set_expand(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

/// All rows if `interlaced`, else the next.
bool read_rows(png_structp png, png_bytepp rows, bool interlaced) {
    if (setjmp(png_jmpbuf(png)) != 0) // NOLINT(cert-err52-cpp)
        return false;
    if (interlaced)
        png_read_image(png, rows);
    else
        png_read_row(png, rows[0], nullptr);
    return true;
}

bool read_end(png_structp png) {
    if (setjmp(png_jmpbuf(png)) != 0) // NOLINT(cert-err52-cpp)
        return false;
    png_read_end(png, nullptr);
    return true;
}

/// What samples mean: of 16 bits, or of 8.
std::vector<float> meanings(bool wide, bool linear) {
    std::vector<float> table(wide ? 65536 : 256);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(table.size() - 1);
        table[i] = static_cast<float>(linear ? value : srgb_to_linear(value));
    }
    return table;
}

class PngReader {
public:
    PngReader(std::string_view bytes, std::string_view name) : source_{bytes}, name_(name) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, keep_error, ignore_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &source_, read_bytes);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    TexturePyramid read(bool linear, Texels kind) {
        const std::size_t bytes = source_.bytes.size();
        check(read_header(png_, info_));
        const png_uint_32 width = png_get_image_width(png_, info_),
                          height = png_get_image_height(png_, info_);
        check_picture_size(name_, width, height, bytes);
        check(begin_rows(png_, info_));
        const std::size_t channels = png_get_channels(png_, info_);
        const bool wide = png_get_bit_depth(png_, info_) == 16;
        const std::vector<float> colours = meanings(wide, linear), opacities = meanings(wide, true);
        const bool interlaced = png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        const std::size_t kept = interlaced ? height : 1; // rows
        const auto samples = std::make_unique_for_overwrite<png_byte[]>(row_bytes * kept);
        std::vector<png_bytep> rows(kept);
        for (std::size_t y = 0; y < kept; ++y)
            rows[y] = samples.get() + y * row_bytes;

        PyramidBuilder builder(static_cast<int>(width), static_cast<int>(height), kind);
        std::vector<glm::vec4> texels(width);
        for (png_uint_32 y = 0; y < height; ++y) {
            if (!interlaced || y == 0)
                check(read_rows(png_, rows.data(), interlaced));
            const png_byte* const row = rows[interlaced ? y : 0];
            const auto sample = [&](std::size_t x, std::size_t c) {
                const std::size_t i = x * channels + c;
                return wide ? std::size_t{row[2 * i]} << 8 | row[2 * i + 1] : std::size_t{row[i]};
            };
            const bool grey = channels < 3, has_opacity = channels % 2 == 0;
            for (std::size_t x = 0; x < width; ++x) {
                for (std::size_t c = 0; c < 3; ++c)
                    texels[x][static_cast<int>(c)] = colours[sample(x, grey ? 0 : c)];
                texels[x].w = has_opacity ? opacities[sample(x, channels - 1)] : 1.0F;
            }
            builder.add_row(texels);
        }
        check(read_end(png_));
        return builder.finish();
    }

private:
    void check(bool done) const {
        if (!done)
            throw UserError(fmt::format("{}: not a readable PNG picture ({}); give another",
                                        printable(name_, 1000), printable(source_.error, 200)));
    }

    Source source_;
    std::string_view name_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

} // namespace

TexturePyramid decode_png(std::string_view bytes, std::string_view name, bool linear, Texels kind) {
    return PngReader(bytes, name).read(linear || kind == Texels::heights, kind);
}

} // namespace razor
