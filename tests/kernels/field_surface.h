// The surface that one ray sees, by its definition: the finest triangulation of every patch, each vertex
// between its anchor and the mean of its parents. In double precision, from the anchors in frame memory; no
// blocks, no tree.
#pragma once

#include "tests/kernels/dump.h"
#include "tests/kernels/rays.h"

#include <glm/vec3.hpp>

#include <vector>

namespace razor::test {

class FieldSurface {
public:
    /// Of a frame whose blocks are all made.
    explicit FieldSurface(Frame& frame);

    struct Crossing {
        double t;
        double slack; // by how much t may differ if vertices are off by their rounding
    };
    /// Where a ray meets its surface, nearest first. `widen`: triangles are that much larger, relative to
    /// their size; what only they meet is a near miss.
    std::vector<Crossing> crossings(const Ray& ray, double widen) const;
    std::size_t vertices() const;
    /// Of those, how many are neither at their anchor nor at their parents' mean for this ray.
    std::size_t between(const Ray& ray) const;

private:
    struct Side {
        int curve = 0;    // exponent of the whole curve, or straight_curve
        int exponent = 0; // of the grid along the whole curve
    };
    struct Grid {
        int instance = 0, first_level = 0, triangles = 2;
        int nu = 0, nv = 0;
        Side side[4];
        bool part = false; // of an n-gon: corners 1 and 3 are middles of edges
        glm::dvec3 middle[2]{};
        std::vector<glm::dvec3> anchors; // row by row
    };
    struct Seen {
        std::vector<glm::dvec3> points;
        std::size_t between = 0;
    };
    Seen see(const Grid& grid, const Ray& ray) const;

    std::vector<Grid> grids_;
    std::vector<Point> origins_;
};

} // namespace razor::test
