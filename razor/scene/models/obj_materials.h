// OBJ cages with the materials of their libraries.
//
// Libraries are files beside the model. Of those that are not there nothing is known, and faces whose
// material no library has are of none; where that goes for all, the cage has no materials of its own. Both
// are noted where the model names libraries.
#pragma once

#include "razor/scene/models/obj_reader.h"
#include "razor/scene/textures/texture_cache.h"

namespace razor {

/// Throws UserError "file:line: cause; mend", also for mistakes in libraries and in textures that they name.
Mesh read_obj(const std::filesystem::path& path, TextureCache& textures);

/// With materials known already, whatever the libraries are: another frame of the same model.
Mesh read_obj(const std::filesystem::path& path, std::shared_ptr<const ModelMaterials> known);

} // namespace razor
