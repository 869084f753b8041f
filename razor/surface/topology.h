// One linear pass over a cage: patches, curves, owners, face classes. No limit surface is evaluated and no
// irregular patch is built here. Everything depends on topology and tags alone, never on point positions
// (except which bilinear polygons are planar, and how concave ones are cut: of Mesh::rest, if it has points).
#pragma once

#include "razor/frame/layout.h"
#include "razor/scene/scene.h"

#include <cstdint>
#include <vector>

namespace razor {

/// A set of faces with equal weights: their neighbourhoods agree in valences, face sizes, sharpness, boundary
/// and in which points of the ring coincide, so one page of weights serves all. Regular faces are one class.
struct FaceClass {
    int representative = 0; // lowest-numbered face of the class, in the mesh's numbering
    int control_count = 0;
    int corner_count = 4;
    bool regular = false;
    /// A corner lies inside a fan of only two faces. Bfr 3.5 crashes on some creases there.
    bool folded = false;
    /// A corner, or an edge that ends at one, is sharp for some levels only.
    bool fading = false;
    /// Bilinear in its corners, which are its control points: no OpenSubdiv.
    bool straight = false;
};

struct Topology {
    std::vector<FaceRecord> faces;    // one a cage face; holes and undrawn faces have no patch
    std::vector<int> controls;        // point indices
    std::vector<int> face_curves;     // curve of edge i of each face (see FaceRecord::curve_first)
    std::vector<VertexRecord> points; // one a cage point; owner_face -1: isolated
    std::vector<CurveRecord> curves;  // cage edges first, then spokes
    std::vector<PatchRecord> patches; // ordered by (face, sub); mesh = 0
    std::vector<FaceClass> classes;
    /// Largest curve exponent for which the pages fit their address range.
    int max_exponent = max_exponent_limit;
    /// Pages hold what displacement along the normal needs: normals of shared points, and how they turn.
    bool displaced = false;
    /// Holes, and faces that boundary interpolation `none` leaves out.
    int undrawn_faces = 0;
};

/// Throws UserError naming the mesh and face where the cage cannot be used (see razor/scene/scene.h for the
/// invariants).
void validate_mesh(const Mesh& mesh);

/// Whether both meshes have one Topology. `factor`, a power of two, takes lengths of a to those of b.
bool same_topology(const Mesh& a, const Mesh& b, double factor);

/// How faces become patches. As shaped: planar faces of a bilinear mesh are flat, two triangles whatever the
/// level. Diced: planar convex ones have grids, too. Displaced: as points will leave the surface along its
/// normal, nothing of it is flat or straight; faces of a bilinear mesh then have classes and patches as limit
/// surfaces have, with bilinear weights: a quad one, any other one for each corner.
enum class Cut : std::uint8_t { as_shaped, diced, displaced };

/// `mesh` must be valid. Throws UserError for cages that cannot be rendered (naming the face and the cause).
/// A flat triangle's sides 0, 1 and 3 are its sides from corner 0 to 1, 1 to 2 and 0 to 2; side 2 has no
/// length. A side that no cage edge runs along has curve -1.
Topology analyse_topology(const Mesh& mesh, Cut cut = Cut::as_shaped);

} // namespace razor
