#include "razor/scene/models/still_cage.h"

#include "razor/scene/models/model_file.h"
#include "razor/scene/models/obj_materials.h"
#include "razor/scene/models/ply_reader.h"

#include <utility>

namespace razor {

Mesh read_still_cage(const std::filesystem::path& path, TextureCache& textures) {
    return lower_extension(path) == ".ply" ? read_ply(path) : read_obj(path, textures);
}

Mesh read_still_cage(const std::filesystem::path& path, std::shared_ptr<const ModelMaterials> known) {
    return lower_extension(path) == ".ply" ? read_ply(path) : read_obj(path, std::move(known));
}

} // namespace razor
