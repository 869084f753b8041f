#include "razor/image/output.h"

#include "razor/image/exr.h"
#include "razor/image/output_file.h"
#include "razor/image/png.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

} // namespace

void check_output(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension != ".exr" && extension != ".png") {
        throw UserError(fmt::format("{}: cannot tell the picture's format; end the name in .exr or .png",
                                    printable(path.string(), 1000)));
    }
    check_writable(path);
}

bool is_png(const std::filesystem::path& path) {
    return extension_of(path) == ".png";
}

void write_image(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes,
                 const Tone& tone) {
    if (is_png(path)) {
        write_png(path, film, attributes, tone);
    } else {
        write_exr(path, film, attributes);
    }
}

} // namespace razor
