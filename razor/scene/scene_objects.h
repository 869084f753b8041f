// The scene graph in scene files: [[object]] and [[group]].
#pragma once

#include "razor/scene/models/cage_source.h"
#include "razor/scene/toml_table.h"

#include <filesystem>

namespace razor {

/// Reads the groups and objects of a scene file into `scene`, whose materials and meshes are read already;
/// files named by tables of instances are added to the meshes. Throws UserError naming the place, also for
/// groups that contain each other and for what flatten() refuses.
void read_objects(TomlTable& root, SceneDescription& scene, const std::filesystem::path& folder,
                  CageCache& cages);

/// Adds a mesh for every file of a table that the scene has no mesh of. `path` is the table's, for messages.
void add_table_meshes(SceneDescription& scene, const InstanceTable& table, const std::string& path,
                      Scheme scheme, const std::string& material, CageCache& cages);

} // namespace razor
