// Ways to make rays for tests.
#pragma once

#include "razor/check/tracer.h"

#include <random>
#include <vector>

namespace razor::test {

using namespace check;

/// Makes rays about a set of triangles, in scene coordinates. All are deterministic.
class RayMaker {
public:
    /// `origins`: of the meshes, relative to the scene's.
    RayMaker(const std::vector<Triangle>& triangles, std::vector<Point> origins, unsigned seed);

    Ray random_ray();
    /// Through a vertex: exactly, where the vertex's coordinates leave room for it.
    Ray at_vertex();
    Ray at_edge();
    Ray along_axis();
    /// Begins on the surface.
    Ray from_surface();
    /// With a range that is tiny, empty, a point or huge.
    Ray odd_range();
    /// Not a ray: NaN, infinite, zero.
    Ray not_a_ray();

    Point random_point();
    Point random_direction();
    /// To a random vertex or edge point from `origin`.
    Point direction_at_feature(const Point& origin);
    float uniform(float low, float high);
    /// 0 ... n-1.
    int pick(int n);

private:
    Point scene(const Triangle& t, const Point& p) const;
    const Triangle& any_triangle();
    const std::vector<Triangle>& triangles_;
    std::vector<Point> origins_;
    Point low_{}, high_{};
    std::mt19937 random_;
};

} // namespace razor::test
