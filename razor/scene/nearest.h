// The known word that a mistyped one most likely meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace razor {

/// Least number of single-character insertions, deletions, replacements and swaps of neighbours between two
/// words.
int edit_distance(std::string_view a, std::string_view b);

/// The first of the `known` words with the least edit distance to `word`; `known` must not be empty.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

} // namespace razor
