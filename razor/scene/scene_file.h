// Scene files in TOML. All keys and their defaults: configs/scenes/default.toml, or --print-config; those of
// materials and textures: razor/scene/material_fields.h and read_materials.h; cameras and lights of models:
// read_from_model.h.
//
// Where a file states no camera, one is placed to see all meshes; where it states neither light nor sky, both
// are chosen (razor/scene/framing.h).
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/framing.h"

#include <filesystem>
#include <string_view>

namespace razor {

/// Reads a scene file. Throws UserError: `file:line:column: cause; mend`.
SceneDescription read_scene_file(const std::filesystem::path& path);

/// The same from text. `file_name` is used in messages; relative mesh files start from `folder`.
SceneDescription parse_scene_file(std::string_view text, std::string_view file_name,
                                  const std::filesystem::path& folder);

/// Whether the name is that of a model or ends in .instances, in any case: what is framed and lit by itself.
bool is_model_file(const std::filesystem::path& path);

/// What `path` holds by its extension: .toml is a scene file; .obj and .ply (also sequences: walk_%03d.obj),
/// .md3, .gltf and .glb are bare models and .instances a table of them (razor/scene/instance_table.h), framed
/// and lit by themselves. Throws UserError for any other extension.
SceneDescription describe(const std::filesystem::path& path, const FramingOptions& framing);

/// The scene of `describe` with default framing: y up.
Scene load_scene(const std::filesystem::path& path);

} // namespace razor
