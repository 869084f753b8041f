// Gives a cage the materials of its file.
#pragma once

#include "razor/scene/scene.h"

namespace razor {

/// `mesh.face_materials`: indices into `own`, -1 standing for none, or empty: none. Where all faces are of
/// one, Mesh::material alone says so. If `own` has none, the cage has none of its own, and
/// keeps it for its notes alone.
void set_own_materials(Mesh& mesh, std::shared_ptr<const ModelMaterials> own);

/// "'a', 'b' and 3 more": what a note is about.
std::string quoted(const std::vector<std::string>& names);

} // namespace razor
