// Sizes of pages and of a class's address range (see "topology pages" in razor/frame/layout.h).
#pragma once

#include "razor/surface/pages.h"

#include <cstdint>
#include <vector>

namespace razor {

/// Lines a mesh's pages may span together, and those of one class (its sections are found by 32-bit line
/// numbers).
inline constexpr std::int64_t mesh_page_lines = std::int64_t{1} << 38;
inline constexpr std::int64_t class_page_lines = std::int64_t{1} << 30;

/// The largest exponent, at most max_exponent_limit, with which the pages fit. Throws UserError if none does.
int largest_exponent(const Mesh& mesh, const std::vector<FaceClass>& classes);

} // namespace razor
