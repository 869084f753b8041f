#include "razor/scene/models/own_materials.h"

#include <algorithm>
#include <utility>

namespace razor {

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
