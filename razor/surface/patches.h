// Patches of one face: whole quads, and sub-faces of n-gons in OpenSubdiv's order (sub-face c: corner c,
// middle of edge c, centre, middle of edge c-1).
#pragma once

#include "razor/surface/adjacency.h"
#include "razor/surface/topology.h"

namespace razor {

void append_quad(const Adjacency& adjacency, int face, PatchKind kind, Topology& topology);

/// One patch a corner; appends the face's spokes too.
void append_sub_faces(const Adjacency& adjacency, int face, PatchKind kind, Topology& topology);

/// Sets a side that runs between two consecutive corners of a face, from `from` to the corner before or after
/// it, along the edge that leads from `edge_corner`.
void set_edge_side(const Adjacency& adjacency, PatchRecord& patch, int side, int edge_corner, int from);

} // namespace razor
