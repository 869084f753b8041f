// Where the vertices of a single-mesh frame belong, in double precision: pages made afresh (razor/surface)
// times the frame's control points, grid exponents worked out again from the cage.
#pragma once

#include "razor/frame/frame.h"
#include "razor/surface/pages.h"

#include <glm/vec3.hpp>

#include <array>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace razor::test {

class ReferenceSurface {
public:
    /// `mesh` is the frame's only one. Keeps a reference to the frame.
    ReferenceSurface(Frame& frame, const Mesh& mesh);

    /// Segments on a curve: 2^exponent. Straight curves of bilinear meshes still have the exponent of their
    /// length.
    int exponent(int curve) const;
    /// Of a patch's grid.
    std::array<int, 2> grid(const PatchRecord& patch) const;
    /// Exponent of the flat edges that a curve is made of: 0 where it is straight.
    int flat_exponent(int curve) const { return straight_ ? 0 : exponent(curve); }
    /// Point number k of 2^flat_exponent on a curve, from its owner.
    glm::dvec3 curve_point(int curve, int k) const;
    /// Vertex (i, j) of a patch's grid by its own weights, not its neighbours'.
    glm::dvec3 grid_point(const PatchRecord& patch, int i, int j) const;
    /// Of single-precision sums of at most 60 products of weights and points.
    double rounding() const { return 60 * 6e-8 * largest_; }
    double largest() const { return largest_; } // coordinate

    const Topology& topology() const { return topology_; }

private:
    glm::dvec3 point(int i) const;
    glm::dvec3 weigh(const FaceRecord& face, const float* weights, std::size_t row, std::size_t column) const;
    glm::dvec3 limit_point(int face, int corner) const;
    glm::dvec3 middle(int curve) const;
    glm::dvec3 centre(int face) const;
    glm::dvec3 corner(const PatchRecord& patch, std::size_t k) const;
    int edge_exponent(int curve) const;
    /// Point k / 2^n of a cage edge's curve, not one of its ends, from its owner.
    glm::dvec3 owner_point(const CurveRecord& curve, int n, int k) const;

    Frame& frame_;
    Topology topology_;
    std::unique_ptr<PageMaker> maker_;
    bool straight_;
    double edge_length_, largest_ = 0;
    using Key = std::tuple<int, int, int, bool, int, int, int, int>;
    mutable std::map<Key, std::vector<float>> pages_;
    const std::vector<float>& page(const PageKey& key, int control_count) const;
};

} // namespace razor::test
