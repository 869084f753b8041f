#include "razor/scene/textures/picture.h"

#include "razor/scene/error.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture_size.h"

#include <fmt/format.h>

#include <new>
#include <utility>

namespace razor {
namespace {

constexpr std::string_view png_magic = "\x89PNG\r\n\x1a\n", jpeg_magic = "\xff\xd8\xff",
                           exr_magic = "\x76\x2f\x31\x01";

/// Formats that textures are often in, by how they begin.
constexpr std::pair<std::string_view, std::string_view> not_read[] = {
    {"GIF8", "a GIF picture"},
    {"BM", "a BMP picture"},
    {"DDS ", "a DDS texture"},
    {"RIFF", "a WebP picture"},
    {"\xabKTX", "a KTX texture"},
    {"II*", "a TIFF picture"},
    {"MM", "a TIFF picture"},
    {"8BPS", "a Photoshop picture"},
    {"version https://git-lfs", "a pointer to a file in Git LFS, not the file"},
};

} // namespace

void check_picture_size(std::string_view name, std::int64_t width, std::int64_t height, std::size_t bytes) {
    const auto fail = [&](std::string_view cause) {
        throw UserError(fmt::format("{}: {} x {} texels {}", printable(name, 1000), width, height, cause));
    };
    if (width < 1 || height < 1)
        fail("are none; give another picture");
    if (width > most_picture_side || height > most_picture_side)
        fail(fmt::format("are too many; give at most {0} x {0}", most_picture_side));
    if (width * height > most_texels)
        fail(fmt::format("are too many; give at most {} in all", most_texels));
    if (!can_hold(bytes, width, height))
        fail(fmt::format("cannot be in {} bytes: it is damaged or cut short; give another picture", bytes));
}

TexturePyramid decode_picture(std::string_view bytes, std::string_view name, bool linear, Texels kind) {
    const auto refusal = [&](std::string_view cause) {
        return UserError(
            fmt::format("{}: {} PNG, JPEG, TGA, OpenEXR or Radiance", printable(name, 1000), cause));
    };
    try {
        if (bytes.starts_with(png_magic))
            return decode_png(bytes, name, linear, kind);
        if (bytes.starts_with(jpeg_magic))
            return decode_jpeg(bytes, name, linear, kind);
        if (bytes.starts_with(exr_magic))
            return decode_exr(bytes, name, kind);
        if (bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE"))
            return decode_radiance(bytes, name, kind);
        if (bytes.empty())
            throw refusal("is empty; give");
        for (const auto& [magic, what] : not_read) // none of which could be TGA: a second byte above 1
            if (bytes.starts_with(magic))
                throw refusal(fmt::format("is {}; convert it to", what));
        if (lower_extension(name) == ".tga" || may_be_tga(bytes))
            return decode_tga(bytes, name, linear, kind);
    } catch (const std::bad_alloc&) {
        throw UserError(
            fmt::format("{}: the picture does not fit in memory; give a smaller one", printable(name, 1000)));
    }
    throw refusal("is no picture that is read; give");
}

TexturePyramid read_picture(const std::filesystem::path& path, bool linear, Texels kind) {
    return decode_picture(read_text_file(path, "a picture"), path.string(), linear, kind);
}

} // namespace razor
