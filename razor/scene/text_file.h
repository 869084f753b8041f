// Whole text files in memory, with clear messages for what is not a readable file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace razor {

/// Larger inputs are refused: no cage that fits the renderer's 32-bit indices needs more.
inline constexpr std::size_t max_text_file_bytes = std::size_t{16} << 30;

/// The bytes of a file (or pipe). Throws UserError if it is missing, a directory, unreadable, empty or too
/// large. `kind` names the expected content in messages, for example "an OBJ file".
std::string read_text_file(const std::filesystem::path& path, std::string_view kind);

/// Remembers a file that something is made of; read_text_file() does so itself. Nobody means to write over it
/// (OutputFile refuses to).
void note_input(const std::filesystem::path& path);
/// Whether it is one of these.
bool is_input(const std::filesystem::path& path);

/// `text` made fit for a one-line message: at most `max_length` characters, control and non-ASCII bytes as
/// \xNN.
std::string printable(std::string_view text, std::size_t max_length = 40);

} // namespace razor
