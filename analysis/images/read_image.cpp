#include "analysis/images/image_file.h"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>

namespace analysis {

double Channel::value(std::size_t i) const {
    if (kind == Kind::float32) {
        return double{std::bit_cast<float>(bits[i])};
    }
    if (kind == Kind::float16) {
        half value;
        value.setBits(static_cast<std::uint16_t>(bits[i]));
        return double{static_cast<float>(value)};
    }
    return static_cast<double>(bits[i]);
}

const Channel* ImageFile::find(std::string_view name) const {
    const auto found = std::find_if(channels.begin(), channels.end(),
                                    [&](const Channel& channel) { return channel.name == name; });
    return found == channels.end() ? nullptr : &*found;
}

ImageFile read_image(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        throw ImageError(
            fmt::format("{}: {}; give an OpenEXR or PNG picture", path.string(),
                        std::filesystem::exists(path, error) ? "is not a file" : "no such file"));
    }
    std::array<char, 4> first{};
    std::ifstream(path, std::ios::binary).read(first.data(), first.size());
    if (std::memcmp(first.data(), "\x76\x2f\x31\x01", 4) == 0) {
        return read_exr(path);
    }
    if (std::memcmp(first.data(), "\x89PNG", 4) == 0) {
        return read_png(path);
    }
    throw ImageError(fmt::format("{}: neither OpenEXR nor PNG; give a picture", path.string()));
}

} // namespace analysis
