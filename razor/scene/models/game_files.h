// Pictures that models of games name by paths below the game's root folder, wherever that is.
#pragma once

#include <filesystem>
#include <string_view>

namespace razor {

/// Whether both are the same but for capital letters of ASCII.
bool same_but_for_case(std::string_view a, std::string_view b);

/// The file that a model in `folder` means by `name`: that path from there, from each folder above, at last
/// its last part beside the model. At each place as it is written, then with .tga, .jpg, .jpeg or .png in
/// place of its extension, then behind it; letters in any case where none agrees, as in games' archives.
/// Empty: there is none.
std::filesystem::path find_game_picture(const std::filesystem::path& folder, std::string_view name);

} // namespace razor
