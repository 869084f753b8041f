// Motion of files in scene files: what [[mesh]] says of how its file is played, and [[mesh.deform]].
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/toml_table.h"

#include <filesystem>

namespace razor {

/// Sets playback and deformers of a mesh whose file is set. `frame_rate` where none is stated; file names are
/// relative to `folder`. Throws UserError naming the place.
void read_playback(TomlTable& table, MeshDescription& mesh, const std::filesystem::path& folder,
                   double frame_rate);

/// Once the cage is read, which says how many frames there are: they come again after the last of them, as
/// keys do. Throws UserError naming the place.
void check_cycle(const TomlTable& table, const Playback& playback);

/// Those keys that say how a clip of a glTF file is played.
void read_clip_playback(TomlTable& table, Playback& playback);
std::string clip_playback_to_toml(const Playback& playback);

/// As they are read; nothing of a mesh that neither moves nor is deformed.
std::string playback_to_toml(const MeshDescription& mesh);
std::string deformers_to_toml(const MeshDescription& mesh);

} // namespace razor
