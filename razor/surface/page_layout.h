// How pages are numbered, and up to which exponent they can be (see "topology pages" in
// razor/frame/layout.h).
#pragma once

#include "razor/surface/pages.h"

#include <cstdint>
#include <vector>

namespace razor {

/// Entries that the pages of one class may have (they are found by 32-bit numbers), and those of a mesh: they
/// take addresses, and memory only where pages are made.
inline constexpr std::int64_t most_class_entries = std::int64_t{1} << 31;
inline constexpr std::int64_t most_mesh_entries = std::int64_t{1} << 38;

/// The largest exponent, at most max_exponent_limit, with which the pages can be numbered. Throws UserError
/// if none is.
int largest_exponent(const Mesh& mesh, const std::vector<FaceClass>& classes);

} // namespace razor
