// How large a picture a file of so many bytes can hold at most.
#pragma once

#include <cstddef>
#include <cstdint>

namespace razor {

/// A bit a texel, and the 1032 bytes for one of which deflate is capable.
inline constexpr std::int64_t most_texels_a_byte = 8 * 1032;

/// Whether width x height texels, each side below 2^31, can be in `bytes` bytes.
constexpr bool can_hold(std::uint64_t bytes, std::int64_t width, std::int64_t height) {
    return static_cast<std::uint64_t>(width * height / most_texels_a_byte) <= bytes;
}

} // namespace razor
