// The hierarchy of the scene graph as it lies in frame memory: single precision relative to a
// double-precision origin, 32-bit indices.
#pragma once

#include "razor/frame/layout.h"
#include "razor/scene/graph/hierarchy.h"

namespace razor {

/// Boxes in scene coordinates (world minus `origin`). They hold the double ones, and whatever becomes of what
/// lies in those in single precision: patches' boxes as the frame makes them, and their grids. child_count is
/// 0 for leaves: how many clusters they have is the frame's to say.
GraphNodeRecord pack(const HierarchyNode& node, const glm::dvec3& origin);

} // namespace razor
