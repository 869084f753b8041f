// Textures on surfaces, as the renderer reads them: pictures, as pyramids of ever coarser levels, or
// patterns.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace razor {

/// What a texture shows beyond its edges (glTF 2.0, sampler.wrapS).
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// What the texels of a pyramid are: colours, or heights to displace surfaces by.
enum class Texels : std::uint8_t { colours, heights };

/// Side of the tiles in which texels lie together: 4 x 4 of 32 bits are one line of a cache.
inline constexpr int texel_tile = 4;
/// 32768 x 32768 texels and all coarser levels.
inline constexpr int most_texture_levels = 16;

/// One level of a pyramid. Row 0 is the top of the picture. Texel (x, y) is word 16 * (y/4 * ceil(width/4) +
/// x/4) + 4 * (y%4) + x%4; words beyond the picture repeat its edge. `texels` hold linear red, green and blue
/// with a shared exponent (see razor/scene/textures/shared_exponent.h); `opacity`, if there is any that is
/// not 1, the same of opacity in all three. Of heights `texels` hold the bits of floats.
struct TextureLevel {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;
    std::vector<std::uint32_t> opacity; // as many, or none
};

/// A picture and its means over ever larger squares, down to one texel.
struct TexturePyramid {
    std::vector<TextureLevel> levels; // of most_texture_levels at most, each half as large, rounded up
    Texels kind = Texels::colours;
    float least = 0, most = 0; // of the picture's heights
    /// Numbers of the picture that were below 0 and are taken as 0 (filters leave some beside what is
    /// bright), and the lowest.
    std::int64_t below_zero = 0;
    float lowest = 0;
};

/// What a texture may be instead of a picture: see razor/kernels/pattern_value.h.
enum class PatternKind : std::uint8_t { checker, bricks, noise, turbulence, marble, wood };
/// What patterns are functions of: points of the object as its mesh has them, or texture coordinates.
enum class PatternSpace : std::uint8_t { object, texture };

struct Pattern {
    PatternKind kind = PatternKind::noise;
    PatternSpace space = PatternSpace::object;
    double size = 1;           // of a cell: check, brick, or feature of noise
    glm::vec3 low{0}, high{1}; // linear colours: of 0 and 1, of mortar and bricks
    int octaves = 6;           // of noise, and what is made of it
    float gain = 0.5F;         // of each octave against the one before
    float amount = 0;          // of bricks the mortar's width, of marble and wood how bent it is, in cells

    bool operator==(const Pattern&) const = default;
};

struct Texture {
    std::string name;
    std::optional<Pattern> pattern; // else a picture
    std::string file;               // absolute path; empty: from within a model
    bool linear = false;            // what the file holds is no sRGB colour
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    std::shared_ptr<const TexturePyramid> pyramid;
    /// What displacement reads of it, red as it is in the file; null where no material's displacement does.
    std::shared_ptr<const TexturePyramid> heights{};
};

} // namespace razor
