// Where the vertices of a mesh lie, undisplaced. Every shared point is evaluated once, by its owner (a cage
// point, a curve, a face), so that neighbours cannot disagree.
#pragma once

#include "razor/surface/topology.h"
#include "tests/reference/cages.h"

#include <memory>

namespace razor::reference {

class Positions {
public:
    virtual ~Positions() = default;
    virtual glm::dvec3 cage_point(int point) const = 0;
    /// Of an n-gon.
    virtual glm::dvec3 face_centre(int face) const = 0;
    /// Point k of 2^depth on a curve.
    virtual glm::dvec3 on_curve(int curve, int k, int depth) const = 0;
    /// Vertex (i, j) of a patch's grid of 2^nu x 2^nv quads, off its border.
    virtual glm::dvec3 inside_patch(int patch, int i, int j, int nu, int nv) const = 0;
};

/// Bilinear in each patch's corners, then bent by `shape`. Keeps references.
std::unique_ptr<Positions> bilinear_positions(const Mesh& mesh, const Topology& topology, const Shape& shape);

/// The Catmull-Clark limit surface, by the project's own weights. Keeps references.
std::unique_ptr<Positions> limit_positions(const Mesh& mesh, const Topology& topology);

} // namespace razor::reference
