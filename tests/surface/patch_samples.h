// Limit points from pages, as a frame evaluates them: weights times control points.
#pragma once

#include "razor/surface/pages.h"

#include <glm/vec3.hpp>

#include <map>
#include <vector>

namespace razor::test {

struct Samples { // of a block: (nu + 1) * (nv + 1), u fastest
    std::vector<glm::dvec3> position, du, dv;
};

/// Pages of one mesh, made once each.
class PagePool {
public:
    PagePool(const Mesh& mesh, const Topology& topology, int level);

    const std::vector<float>& page(const PageKey& key);
    /// Weights in single precision times points in double, or all in single (points relative to the first
    /// point).
    std::vector<glm::dvec3> apply(const PageKey& key, int face, std::size_t count, std::size_t row,
                                  std::size_t rows_a_point, std::size_t which, bool single) const;
    /// The first block of the patch at exponents (n, n), n <= 3.
    Samples block(const PatchRecord& patch, int n, bool single = false);
    /// The points of the curve at exponent n <= 3, in its own direction, from its owner's page.
    std::vector<glm::dvec3> curve(int curve, int n);
    glm::dvec3 vertex(int point);

private:
    const Mesh& mesh_;
    const Topology& topology_;
    PageMaker maker_;
    mutable std::map<std::vector<int>, std::vector<float>> pages_;
};

/// The curve parameter of a point at s along a side.
double curve_parameter(int side_flags, double s);

} // namespace razor::test
