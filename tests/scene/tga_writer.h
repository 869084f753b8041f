// TGA pictures as bytes, after the format's specification, for tests of what reads them: every type, depth,
// corner and way of storing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace razor {

/// Red, green, blue, opacity.
using TgaColour = std::array<std::uint8_t, 4>;

struct TgaKind {
    int type = 2; // 1, 2, 3; 8 more: in runs
    int bits = 24, opacity_bits = 0;
    bool from_right = false, from_top = false;
    int first = 0, entry_bits = 24; // of a mapped one's map
    std::string name{};             // in front of all
    std::vector<TgaColour> map{};   // of a mapped one, whose texels have the entry's number as red; of others
                                    // something to be skipped
    bool whole_rows = true;         // no run goes on in the next row
    std::string footer{};
};

inline void put_tga_colour(std::string& bytes, const TgaColour& c, int bits) {
    const auto put = [&](int value) { bytes += static_cast<char>(static_cast<std::uint8_t>(value)); };
    if (bits > 16) {
        for (const std::size_t channel : {2U, 1U, 0U})
            put(c[channel]);
        if (bits == 32)
            put(c[3]);
        return;
    }
    const int word = (c[3] >= 128 ? 1 << 15 : 0) | (c[0] >> 3) << 10 | (c[1] >> 3) << 5 | c[2] >> 3;
    put(word & 0xff);
    put(word >> 8);
}

/// `texels`: row after row, from the top left.
inline std::string tga_of(int width, int height, const TgaKind& kind, const std::vector<TgaColour>& texels) {
    std::string bytes;
    const auto put = [&](std::size_t value, int count = 1) {
        for (int i = 0; i < count; ++i)
            bytes += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    const auto number = [](int value) { return static_cast<std::size_t>(value); };
    put(kind.name.size());
    put(kind.map.empty() ? 0 : 1);
    put(number(kind.type));
    put(number(kind.first), 2);
    put(kind.map.size(), 2);
    put(kind.map.empty() ? 0 : number(kind.entry_bits));
    put(0x1234, 2); // where on a screen
    put(0x5678, 2);
    put(number(width), 2);
    put(number(height), 2);
    put(number(kind.bits));
    put(number(kind.opacity_bits | (kind.from_right ? 16 : 0) | (kind.from_top ? 32 : 0)));
    bytes += kind.name;
    for (const TgaColour& colour : kind.map)
        put_tga_colour(bytes, colour, kind.entry_bits);

    std::vector<std::string> stored; // a texel each, as they follow each other
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int column = kind.from_right ? width - 1 - x : x, row = kind.from_top ? y : height - 1 - y;
            const TgaColour& c = texels[number(row * width + column)];
            std::string& texel = stored.emplace_back();
            if (kind.type % 8 == 2) {
                put_tga_colour(texel, c, kind.bits);
            } else {
                const int value = kind.type % 8 == 1 ? c[0] + kind.first : c[0];
                texel += static_cast<char>(static_cast<std::uint8_t>(value & 0xff));
                if (kind.bits == 16)
                    texel +=
                        static_cast<char>(static_cast<std::uint8_t>(kind.type % 8 == 1 ? value >> 8 : c[3]));
            }
        }
    for (std::size_t at = 0; at < stored.size();) {
        if (kind.type < 8) {
            bytes += stored[at++];
            continue;
        }
        const std::size_t row_end =
            kind.whole_rows ? (at / number(width) + 1) * number(width) : stored.size();
        const auto alike = [&](std::size_t i) { return i < row_end && stored[i] == stored[at]; };
        std::size_t count = 1;
        while (count < 128 && alike(at + count))
            ++count;
        if (count > 1) {
            put(128 + count - 1);
            bytes += stored[at];
        } else { // up to where two are alike
            while (count < 128 && at + count < row_end &&
                   (at + count + 1 >= row_end || stored[at + count] != stored[at + count + 1]))
                ++count;
            put(count - 1);
            for (std::size_t i = 0; i < count; ++i)
                bytes += stored[at + i];
        }
        at += count;
    }
    return bytes + kind.footer;
}

} // namespace razor
