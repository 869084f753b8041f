// Radiance pictures as bytes, with and without run lengths, for tests of what reads them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace razor {

using RgbePixel = std::array<std::uint8_t, 4>;

enum class RadianceRuns : std::uint8_t { none, old, each };

/// Pixels of which some are alike, none of which looks like a run's.
inline std::vector<RgbePixel> ramp_of_pixels(std::size_t count) {
    std::vector<RgbePixel> pixels;
    for (std::size_t i = 0; i < count; ++i) {
        const auto step = static_cast<std::uint8_t>(i / 3);
        pixels.push_back({static_cast<std::uint8_t>(3 * step + 5), static_cast<std::uint8_t>(255 - step), 128,
                          static_cast<std::uint8_t>(124 + step % 8)});
    }
    return pixels;
}

/// Rows from the top.
inline std::string radiance_of(std::size_t width, std::size_t height, const std::vector<RgbePixel>& pixels,
                               RadianceRuns runs, const std::string& header = "FORMAT=32-bit_rle_rgbe\n") {
    std::string bytes = "#?RADIANCE\n# by a test\n" + header + "\n-Y " + std::to_string(height) + " +X " +
                        std::to_string(width) + "\n";
    const auto put = [&](std::size_t value) { bytes += static_cast<char>(static_cast<std::uint8_t>(value)); };
    for (std::size_t y = 0; y < height; ++y) {
        const RgbePixel* const row = pixels.data() + y * width;
        if (runs == RadianceRuns::each) {
            for (const std::size_t value : {std::size_t{2}, std::size_t{2}, width >> 8U, width & 0xffU})
                put(value);
            for (std::size_t c = 0; c < 4; ++c)
                for (std::size_t x = 0; x < width;) { // two alike are a run, others go one by one
                    std::size_t count = 1;
                    while (count < 127 && x + count < width && row[x + count][c] == row[x][c])
                        ++count;
                    put(count > 1 ? 128 + count : 1);
                    put(row[x][c]);
                    x += count;
                }
            continue;
        }
        for (std::size_t x = 0; x < width;) {
            std::size_t count = 1;
            while (runs == RadianceRuns::old && x + count < width && row[x + count] == row[x])
                ++count;
            for (const std::uint8_t component : row[x])
                put(component);
            for (std::size_t rest = count - 1; rest > 0; rest >>= 8U) // the lowest byte first
                for (const std::size_t value : {std::size_t{1}, std::size_t{1}, std::size_t{1}, rest & 0xffU})
                    put(value);
            x += count;
        }
    }
    return bytes;
}

} // namespace razor
