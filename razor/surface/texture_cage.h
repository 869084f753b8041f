// Texture coordinates as a surface of their own over the faces of a mesh: a cage whose points are texture
// coordinates (z = 0), faces as those of the mesh, in the same order. What the mesh's scheme makes of the one
// it makes of the other, so that one parametrisation, one set of weights and one diced grid serve both.
#pragma once

#include "razor/surface/topology.h"

namespace razor {

/// Whether each face takes its texture coordinates from its own corners alone.
bool has_linear_texcoords(const Mesh& mesh);

/// The mesh must be valid and have texture coordinates. A point of the cage is a texture coordinate at a
/// point of the mesh: faces around it that have the same there are one surface (OpenSubdiv's face-varying
/// values). Seams are boundaries, sharpened as Mesh::face_varying says
/// (Sdc::Options::FVarLinearInterpolation). Corners without a coordinate (-1) have (0, 0).
Mesh texture_cage(const Mesh& mesh);

/// Of that cage, for faces of `mesh`'s numbers: no patches, no curves. Where coordinates are linear, faces
/// have no class and their corners as controls. `displaced`: as of the mesh, see Topology.
Topology analyse_texture_cage(const Mesh& mesh, const Mesh& cage, bool displaced = false);

} // namespace razor
