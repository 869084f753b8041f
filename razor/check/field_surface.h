// The surface that rays of one field see, by its definition: the finest triangulation of every patch, each
// vertex between its anchor and the mean of its parents. In double precision, from the anchors in frame
// memory; no blocks, no kd-tree. Patches are only blended when a ray comes near them: every vertex is a mean
// of anchors of its patch (and of the ends of the edges that a sub-face halves), so it lies in their box.
#pragma once

#include "razor/check/dump.h"
#include "razor/check/tracer.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace razor::check {

/// Bounds of points.
struct Extent {
    glm::dvec3 low{1e300}, high{-1e300};
    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const Extent& e) {
        low = glm::min(low, e.low);
        high = glm::max(high, e.high);
    }
    /// Whether a line meets the box made larger by `wider` to all sides.
    bool meets(const glm::dvec3& from, const glm::dvec3& inverse, double wider) const;
};

class FieldSurface {
public:
    /// Of a frame whose blocks are all made.
    explicit FieldSurface(Frame& frame);

    std::size_t vertices() const;
    std::size_t patches() const { return grids_.size(); }
    /// The finest grid of a patch, 2^nu x 2^nv quads, from its instance's origin.
    struct Shape {
        int nu = 0, nv = 0, first_level = 0, triangles = 2;
        glm::dvec3 origin{0};
    };
    Shape shape(int patch) const;
    /// Of everything, scene coordinates.
    const Extent& extent() const { return extent_; }
    /// Absolute levels of detail that some patch has: the finest, and one that is coarser than all.
    int finest_level() const { return finest_; }
    int coarsest_level() const { return coarsest_; }

private:
    friend class SeenSurface;
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
    /// Of a tree over the patches' boxes (scene coordinates): leaves have one patch.
    struct Node {
        Extent box;
        int patch = -1;
        int second = -1; // child; the first one follows
    };
    int build(std::vector<int>& order, std::size_t begin, std::size_t end);
    glm::dvec3 origin_of(const Grid& grid) const;

    std::vector<Grid> grids_;
    std::vector<Extent> boxes_; // of each, scene coordinates
    std::vector<Node> nodes_;
    std::vector<Point> origins_;
    Extent extent_;
    int finest_ = 0, coarsest_ = 0;
};

class SeenSurface {
public:
    /// As `asks` sees it: by its origin, base and growth. Keeps a reference to the surface.
    SeenSurface(const FieldSurface& surface, const Ray& asks);

    struct Crossing {
        double t;
        double slack; // by how much t may differ if vertices and the ray are off by their rounding
    };
    /// Where a ray meets the surface, nearest first. `roundings`: what passes a triangle by that many times
    /// the unit roundoff of single precision, relative to the largest coordinate or distance that goes into
    /// the test, is met too; negative: what it passes inside the border by less is not.
    std::vector<Crossing> crossings(const Ray& ray, double roundings);
    /// The same without looking at any box.
    std::vector<Crossing> crossings_of_all(const Ray& ray, double roundings);
    /// The vertices of a patch's finest grid, row by row, from its instance's origin.
    const std::vector<glm::dvec3>& points(int patch) { return blended(patch).points; }
    /// Whether a point is inside: an odd number of crossings along each of three directions.
    bool inside(const Point& p);
    /// Vertices that are neither at their anchor nor at their parents' mean.
    std::size_t between();
    /// A point of patch `number` modulo their number, scene coordinates: a vertex or, for `along` > 0, that
    /// share of the way to a neighbour. `place` chooses which; vertices of coarse levels are as likely as
    /// those of fine ones.
    glm::dvec3 feature(std::uint32_t number, std::uint32_t place, double along);

private:
    struct Blended {
        std::vector<glm::dvec3> points;
        std::vector<Extent> tiles; // of 8 x 8 quads, row by row
        std::size_t between = 0;
    };
    const Blended& blended(int patch);
    void meet_patch(int patch, const Ray& ray, double roundings, bool use_boxes,
                    std::vector<Crossing>& found);

    const FieldSurface& surface_;
    Ray asks_;
    std::vector<int> number_; // of a patch's entry in blended_, or -1
    std::vector<Blended> blended_;
};

} // namespace razor::check
