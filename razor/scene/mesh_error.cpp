#include "razor/scene/mesh_error.h"

#include "razor/scene/description.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {

std::string file_of_mesh(const SceneDescription& description, const std::string& mesh) {
    const auto found = std::find_if(description.meshes.begin(), description.meshes.end(),
                                    [&](const MeshDescription& m) { return m.name == mesh; });
    return found == description.meshes.end() || found->file.empty()
               ? ""
               : fmt::format("{}: ", printable(found->file, 1000));
}

} // namespace razor
