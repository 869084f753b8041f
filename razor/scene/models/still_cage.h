// Files that hold one cage which stands still: OBJ with its materials, PLY.
#pragma once

#include "razor/scene/scene.h"
#include "razor/scene/textures/texture_cache.h"

#include <filesystem>

namespace razor {

/// A PLY file by its name's extension, in any case, else an OBJ file. Throws UserError.
Mesh read_still_cage(const std::filesystem::path& path, TextureCache& textures);

/// With materials known already, or none: another frame of the same model.
Mesh read_still_cage(const std::filesystem::path& path, std::shared_ptr<const ModelMaterials> known);

} // namespace razor
