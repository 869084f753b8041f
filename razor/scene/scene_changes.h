// What is other in a scene than it was a moment before.
#pragma once

#include "razor/scene/graph/flatten.h"

#include <vector>

namespace razor {

/// Camera and lights apart. All else is as it was.
struct SceneChanges {
    std::vector<PlacementName> placements; // whose local transforms are others
    std::vector<int> meshes;               // whose points are others
};

} // namespace razor
