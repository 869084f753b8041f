#include "razor/scene/models/own_materials.h"

#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace razor {

std::string quoted(const std::vector<std::string>& names) {
    constexpr std::size_t most = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
        list += fmt::format("{}'{}'", i == 0 ? "" : ", ", printable(names[i]));
    return names.size() > most ? fmt::format("{} and {} more", list, names.size() - most) : list;
}

void set_own_materials(Mesh& mesh, std::shared_ptr<const ModelMaterials> own) {
    if (own->materials.empty()) {
        mesh.face_materials.clear();
        if (own->notes.empty())
            return;
    }
    std::vector<int>& of_faces = mesh.face_materials;
    if (of_faces.empty()) {
        mesh.material = -1;
    } else if (std::all_of(of_faces.begin(), of_faces.end(), [&](int m) { return m == of_faces.front(); })) {
        mesh.material = of_faces.front();
        of_faces.clear();
    }
    mesh.own_materials = std::move(own);
}

} // namespace razor
