// Rays of one's own through a frame, by a target's kernels: for checks and tests.
#pragma once

#include "razor/check/dump.h"

#include <cstdint>
#include <vector>

namespace razor::check {

/// In scene coordinates and the frame's unit (Frame::unit), as are hits.
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
    /// Rays may begin so many times the reach of scene and camera away.
    Tracer(Frame& frame, int capacity, double reaches = 100);
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

/// Of all instances, in scene coordinates.
std::vector<Point> instance_origins(Frame& frame);

} // namespace razor::check
