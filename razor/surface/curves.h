// Curves that patches share, and who evaluates shared points (see the top of razor/frame/layout.h).
#pragma once

#include "razor/surface/adjacency.h"
#include "razor/surface/topology.h"

#include <vector>

namespace razor {

/// Fills face_curves (and FaceRecord::curve_first), the curves of all cage edges, and the owners of all
/// points. Curve i is edge i of `adjacency`. An edge or point that no drawn face touches has owner_face -1.
void build_edge_curves(const Adjacency& adjacency, const std::vector<bool>& drawn, Topology& topology);

/// Appends the spokes of one face: curve `result + i` runs from the middle of edge i to the centre.
int append_spokes(const Adjacency& adjacency, int face, Topology& topology);

} // namespace razor
