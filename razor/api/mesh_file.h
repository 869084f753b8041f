// Diced meshes as OBJ files.
#pragma once

#include "razor/api/renderer.h"

namespace razor::api {

/// Of a scene as its camera sees it; `isa`: of the kernels that dice it. Throws UserError.
MeshFigures write_mesh_file(const std::filesystem::path& file, const razor::Scene& scene,
                            const std::string& isa);

} // namespace razor::api
