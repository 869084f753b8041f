// The known word that a mistyped one most likely meant, if any is near.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace razor {

/// Least number of single-character insertions, deletions, replacements and swaps of neighbours between two
/// words.
int edit_distance(std::string_view a, std::string_view b);

/// Whether a word is so like a known one that it may be that, mistyped, shortened or with another ending: at
/// most a third of the letters of the shorter one are edits (one of two letters), or both begin with the same
/// three letters, or more, that are two thirds of the shorter one. Dashes before options are no letters.
bool is_near(std::string_view word, std::string_view known);

/// The first of those of the `known` words that are near with the least edit distance; empty: none is near.
std::string_view meant(std::string_view word, std::span<const std::string_view> known);

/// How a line on a word that is unknown ends: "did you mean 'size'? Known: size, crop", or "known: size,
/// crop" where none is near. `lead`: before the list.
std::string or_known(std::string_view word, std::span<const std::string_view> known,
                     std::string_view lead = "Known");

} // namespace razor
