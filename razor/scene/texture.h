// Pictures on surfaces, as the renderer reads them: pyramids of ever coarser levels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace razor {

/// What a texture shows beyond its edges (glTF 2.0, sampler.wrapS).
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// Side of the tiles in which texels lie together: 4 x 4 of 32 bits are one line of a cache.
inline constexpr int texel_tile = 4;
/// 32768 x 32768 texels and all coarser levels.
inline constexpr int most_texture_levels = 16;

/// One level of a pyramid. Row 0 is the top of the picture. Texel (x, y) is word 16 * (y/4 * ceil(width/4) +
/// x/4) + 4 * (y%4) + x%4; words beyond the picture repeat its edge. `texels` hold linear red, green and blue
/// with a shared exponent (see razor/scene/textures/shared_exponent.h); `opacity`, if there is any that is
/// not 1, the same of opacity in all three.
struct TextureLevel {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;
    std::vector<std::uint32_t> opacity; // as many, or none
};

/// A picture and its means over ever larger squares, down to one texel.
struct TexturePyramid {
    std::vector<TextureLevel> levels; // of most_texture_levels at most, each half as large, rounded up
};

struct Texture {
    std::string name;
    std::string file;    // absolute path; empty: from within a model
    bool linear = false; // what the file holds is no sRGB colour
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    std::shared_ptr<const TexturePyramid> pyramid;
};

} // namespace razor
