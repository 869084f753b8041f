// Which faces share their pages of weights.
#pragma once

#include "razor/surface/adjacency.h"
#include "razor/surface/topology.h"

#include <vector>

namespace razor {

/// Fills controls, classes, and each drawn face's class and control list. Throws UserError for faces with too
/// many control points and for creases that OpenSubdiv 3.5 cannot evaluate.
void assign_face_classes(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                         Topology& topology);

/// The same of faces that are bilinear in their corners: one class for all with as many.
void assign_straight_classes(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                             Topology& topology);

} // namespace razor
