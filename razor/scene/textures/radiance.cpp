// Radiance pictures (.hdr, .pic), by the file format that Radiance's manual describes (G. Ward, "Radiance
// File Formats") and its sources write: lines of text, how it lies, then scanlines of red, green, blue and a
// common exponent: as they are, with old run lengths (a pixel 1 1 1 n: the one before n times, n's bytes in
// pixels that follow each other from the lowest), or each component with its own.
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/shared_exponent.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace razor {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

// Of scanlines whose components have run lengths of their own; others have none.
constexpr std::size_t least_width = 8, most_width = 0x7fff;

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
    text.remove_prefix(begin);
    return text.substr(0, text.find_last_not_of(" \t\r") + 1);
}

std::string_view take_word(std::string_view& text) {
    text = trimmed(text);
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    return word;
}

template <class Number> std::optional<Number> to_number(std::string_view word) {
    Number value{};
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || stop != word.data() + word.size())
        return std::nullopt;
    return value;
}

class RadianceReader {
public:
    RadianceReader(std::string_view bytes, std::string_view name)
        : bytes_(bytes), all_(bytes.size()), name_(name) {}

    TexturePyramid read(Texels kind) {
        read_header();
        read_size();
        const auto columns = static_cast<std::size_t>(width_);
        std::vector<Pixel> pixels(columns);
        std::vector<glm::vec4> texels(columns);
        PyramidBuilder builder(width_, height_, kind);
        for (row_ = 0; row_ < height_; ++row_) {
            read_scanline(pixels);
            std::transform(pixels.begin(), pixels.end(), texels.begin(),
                           [&](const Pixel& pixel) { return glm::vec4(light_of(pixel, kind), 1); });
            builder.add_row(texels);
        }
        return builder.finish();
    }

private:
    [[noreturn]] void fail(std::string_view message) const {
        throw UserError(fmt::format("{}: {}", printable(name_, 1000), message));
    }
    [[noreturn]] void fail_in_row(std::string_view cause) const {
        fail(
            fmt::format("{} in row {} of {}: it is damaged; give another picture", cause, row_ + 1, height_));
    }

    std::string_view take_line() {
        const std::size_t end = bytes_.find('\n');
        if (end == std::string_view::npos)
            fail("ends before its size is said: it is cut short; give another picture");
        const std::string_view line = bytes_.substr(0, end);
        bytes_.remove_prefix(end + 1);
        return trimmed(line);
    }

    void read_header() {
        take_line(); // which says that it is one
        for (std::string_view line = take_line(); !line.empty(); line = take_line()) {
            const std::size_t sign = line.find('=');
            if (line.front() == '#' || sign == std::string_view::npos)
                continue; // what was done to it
            const std::string_view variable = trimmed(line.substr(0, sign));
            std::string_view value = trimmed(line.substr(sign + 1));
            if (variable == "FORMAT" && value != "32-bit_rle_rgbe")
                fail(fmt::format("is of format '{}', not 32-bit_rle_rgbe; convert it with `ra_xyze -r`",
                                 printable(value)));
            if (variable == "EXPOSURE")
                exposure_ *= factor(take_word(value), variable);
            if (variable == "COLORCORR")
                for (int c = 0; c < 3; ++c)
                    exposure_[c] *= factor(take_word(value), variable);
        }
    }
    /// By which all pixels were multiplied.
    double factor(std::string_view word, std::string_view variable) const {
        const std::optional<double> number = to_number<double>(word);
        if (!number || !(*number >= 1e-30 && *number <= 1e30))
            fail(fmt::format("has {} '{}', which is no factor from 1e-30 to 1e30; mend its header", variable,
                             printable(word)));
        return *number;
    }

    void read_size() {
        const std::string_view line = take_line();
        std::string_view rest = line;
        const std::array<std::string_view, 4> words{take_word(rest), take_word(rest), take_word(rest),
                                                    take_word(rest)};
        const std::optional<int> first = to_number<int>(words[1]), second = to_number<int>(words[3]);
        if (!first || !second || !trimmed(rest).empty())
            fail(fmt::format("has '{}' where its size belongs; give another picture", printable(line)));
        if (words[0] != "-Y" || words[2] != "+X")
            fail(fmt::format("lies as '{}', not from the top left, row by row ('-Y {} +X {}'); convert it",
                             printable(line), *first, *second));
        height_ = *first;
        width_ = *second;
        check_picture_size(name_, width_, height_, all_);
    }

    std::uint8_t take_byte() {
        if (bytes_.empty())
            fail_in_row("the file ends");
        const auto byte = static_cast<std::uint8_t>(bytes_.front());
        bytes_.remove_prefix(1);
        return byte;
    }
    Pixel take_pixel() {
        Pixel pixel{};
        for (std::uint8_t& component : pixel)
            component = take_byte();
        return pixel;
    }

    void read_scanline(std::vector<Pixel>& pixels) {
        if (pixels.size() >= least_width && pixels.size() <= most_width && bytes_.size() >= 4 &&
            bytes_[0] == 2 && bytes_[1] == 2 && (static_cast<std::uint8_t>(bytes_[2]) & 0x80U) == 0) {
            const Pixel head = take_pixel();
            if (std::size_t{head[2]} << 8U != (pixels.size() & ~std::size_t{0xff}) ||
                head[3] != (pixels.size() & 0xffU))
                fail_in_row("a scanline is of another length");
            for (std::size_t c = 0; c < 4; ++c)
                read_component(pixels, c);
            return;
        }
        read_old_scanline(pixels);
    }

    /// Above 128: a run of so many less 128; else so many bytes as they are.
    void read_component(std::vector<Pixel>& pixels, std::size_t component) {
        for (std::size_t x = 0; x < pixels.size();) {
            const std::uint8_t code = take_byte();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128U : code;
            if (count == 0 || count > pixels.size() - x)
                fail_in_row("a run is of no pixel, or of more than there are,");
            const std::uint8_t value = run ? take_byte() : std::uint8_t{0};
            for (const std::size_t end = x + count; x < end; ++x)
                pixels[x][component] = run ? value : take_byte();
        }
    }

    void read_old_scanline(std::vector<Pixel>& pixels) {
        unsigned shift = 0;
        for (std::size_t x = 0; x < pixels.size();) {
            const Pixel pixel = take_pixel();
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                pixels[x++] = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : pixels.size() + 1;
            if (x == 0 || count > pixels.size() - x)
                fail_in_row("a run is of no pixel, or of more than there are,");
            std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(x), count, pixels[x - 1]);
            x += count;
            shift += 8;
        }
    }

    /// (m + 1/2) / 256 2^(e - 128), as Radiance has it, which cuts mantissas off; black where e is 0. Over
    /// what it was multiplied by.
    glm::vec3 light_of(const Pixel& pixel, Texels kind) const {
        if (pixel[3] == 0)
            return glm::vec3(0);
        const double scale = std::ldexp(1.0, int{pixel[3]} - 136);
        const glm::dvec3 light = scale * (glm::dvec3(pixel[0], pixel[1], pixel[2]) + 0.5) / exposure_;
        const double most = kind == Texels::heights ? 1e37 : double{most_shared};
        return glm::vec3(glm::min(light, glm::dvec3(most)));
    }

    std::string_view bytes_; // what is left
    std::size_t all_;
    std::string_view name_;
    glm::dvec3 exposure_{1};
    int width_ = 0, height_ = 0, row_ = 0;
};

} // namespace

TexturePyramid decode_radiance(std::string_view bytes, std::string_view name, Texels kind) {
    return RadianceReader(bytes, name).read(kind);
}

} // namespace razor
