#include "analysis/images/linear_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// A table of all codes: powers are slow.
std::vector<float> decoded_codes(std::size_t count) {
    std::vector<float> table(count);
    for (std::size_t i = 0; i < count; ++i) {
        table[i] = static_cast<float>(decode_srgb(static_cast<double>(i) / static_cast<double>(count - 1)));
    }
    return table;
}

std::vector<float> light_of(const Channel& channel) {
    std::vector<float> out(channel.bits.size());
    if (channel.kind == Channel::Kind::uint8 || channel.kind == Channel::Kind::uint16) {
        const std::vector<float> table = decoded_codes(channel.kind == Channel::Kind::uint8 ? 256 : 65536);
        std::transform(channel.bits.begin(), channel.bits.end(), out.begin(),
                       [&](std::uint32_t code) { return table[code]; });
    } else {
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = static_cast<float>(channel.value(i));
        }
    }
    return out;
}

} // namespace

bool is_display_referred(const ImageFile& image) {
    return !image.channels.empty() && (image.channels.front().kind == Channel::Kind::uint8 ||
                                       image.channels.front().kind == Channel::Kind::uint16);
}

LinearImage linear_rgb(const ImageFile& image, const std::string& name) {
    LinearImage out;
    out.width = image.width;
    out.height = image.height;
    const Channel* const grey = image.find("Y");
    constexpr std::array<const char*, 3> names{"R", "G", "B"};
    const bool colour = std::any_of(names.begin(), names.end(), [&](const char* c) { return image.find(c); });
    for (std::size_t c = 0; c < 3; ++c) {
        const Channel* const channel = grey != nullptr && !colour ? grey : image.find(names[c]);
        if (channel == nullptr) {
            throw ImageError(fmt::format("{}: has no channel {}; give a picture with R, G and B, or with Y",
                                         name, names[c]));
        }
        out.planes[c] = light_of(*channel);
    }
    return out;
}

} // namespace analysis
