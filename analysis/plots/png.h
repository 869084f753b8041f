// Pictures of pixels as PNG bytes, and bytes as text that pages hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

struct Pixels {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb; // rows from the top, three bytes a pixel
};
/// 8 bits a channel, without times: equal pixels are equal bytes. Throws std::runtime_error where libpng does
/// not want to, as of an empty picture.
std::string png_bytes(const Pixels& pixels);
/// "data:image/png;base64,..." (RFC 2397, RFC 4648).
std::string data_uri(std::string_view png);

} // namespace analysis
