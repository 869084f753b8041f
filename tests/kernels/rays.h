// Rays for tests, ways to make them, and tracing them by a target's kernels.
#pragma once

#include "tests/kernels/dump.h"

#include <cstdint>
#include <random>
#include <vector>

namespace razor::test {

struct Ray {
    Point origin{}, direction{};
    float t_min = 0, t_max = 3.0e38F;
    /// Target edge length at the origin, and its growth with distance; base 0: the finest level everywhere.
    float base = 0, growth = 0;
    Point slope{}; // see TraceArguments
};

struct Hit {
    int patch = -1, triangle = -1;
    float t = 0, u = 0, v = 0;

    /// The same hit: everything if it is one, u and v as numbers (a zero's sign is nobody's business).
    bool operator==(const Hit& o) const {
        if (patch < 0 || o.patch < 0)
            return patch < 0 && o.patch < 0;
        return patch == o.patch && triangle == o.triangle && t == o.t && u == o.u && v == o.v;
    }
};

/// Traces rays through a frame's tree, which is built as they go. Made before anything else happens to the
/// frame.
class Tracer {
public:
    Tracer(Frame& frame, int capacity);
    std::vector<Hit> closest(const KernelTable& kernels, const std::vector<Ray>& rays);
    /// Whether each ray meets anything.
    std::vector<bool> any(const KernelTable& kernels, const std::vector<Ray>& rays);

private:
    TraceArguments fill(const std::vector<Ray>& rays);
    Frame& frame_;
    std::size_t capacity_;
    float* in_[13];
    float* out_[3];
    std::int32_t* names_[2];
};

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

/// Of all instances, in scene coordinates.
std::vector<Point> instance_origins(Frame& frame);

} // namespace razor::test
