// Map statements of MTL libraries: options, then a file's name (Wavefront, "MTL material format", section
// "Texture map statements"; also in the Advanced Visualizer's manual, appendix B).
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

/// What its values mean, which decides what options do.
enum class MtlMapUse : std::uint8_t { colour, scalar, bump, displacement };

struct MtlMap {
    std::string file; // may hold blanks; empty: none is stated
    std::int64_t line = 0;
    glm::vec2 scale{1, 1}, offset{0, 0};
    bool clamp = false;
    double base = 0, gain = 1; // of -mm: a value v of the file counts as base + gain v
    double bump = 1;           // of -bm
    /// Options that are passed over, though they change what is seen: unknown ones, those that such a map has
    /// not, and what is not supported.
    std::vector<std::string> passed_over;
};

/// `text`: what follows the keyword. Throws UserError "cause; mend" where -mm or -bm have no numbers.
MtlMap parse_mtl_map(std::string_view text, MtlMapUse use, std::int64_t line);

} // namespace razor
