// A mistake in a mesh, found where only its name is known.
#pragma once

#include "razor/scene/error.h"

#include <string>
#include <utility>

namespace razor {

struct SceneDescription;

/// what(): as of a UserError, beginning with the mesh's name.
class MeshError : public UserError {
public:
    MeshError(std::string mesh, const std::string& what) : UserError(what), mesh_(std::move(mesh)) {}
    const std::string& mesh() const { return mesh_; }

private:
    std::string mesh_;
};

/// "FILE: " of the mesh of that name; empty: it is of no file.
std::string file_of_mesh(const SceneDescription& description, const std::string& mesh);

/// What `work` returns; its MeshErrors get the file that the mesh is from in front.
template <class Work> auto naming_files(const SceneDescription& description, const Work& work) {
    try {
        return work();
    } catch (const MeshError& error) {
        throw UserError(file_of_mesh(description, error.mesh()) + error.what());
    }
}

} // namespace razor
