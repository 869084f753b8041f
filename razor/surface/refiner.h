// The cage as OpenSubdiv wants it.
#pragma once

#include "razor/scene/scene.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <vector>

namespace razor {

/// The unrefined base level of a Catmull-Clark mesh, which must be valid (validate_mesh). Throws UserError
/// where OpenSubdiv refuses it.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const Mesh& mesh);

/// One entry a face: whether it has a limit surface. Holes have none; under boundary interpolation `none`
/// neither has a face that touches a boundary which is not infinitely sharp.
std::vector<bool> faces_with_limit_surface(const Mesh& mesh);

} // namespace razor
