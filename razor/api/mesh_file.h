// Diced meshes as OBJ files.
#pragma once

#include "razor/api/renderer.h"

#include <atomic>

namespace razor::api {

/// Of a scene as its camera sees it; `isa`: of the kernels that dice it. `cancel`: null, or set to true from
/// anywhere to stop early. Throws UserError, and Cancelled.
MeshFigures write_mesh_file(const std::filesystem::path& file, const razor::Scene& scene,
                            const std::string& isa, const std::atomic<bool>* cancel);

} // namespace razor::api
