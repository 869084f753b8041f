// Closest hits by brute force over every triangle of a frame: plain scalar code that shares nothing with the
// kernels but the order of its single-precision operations (Woop, Benthin & Wald, JCGT 2013), so that hits
// can be compared bit for bit.
#pragma once

#include "tests/kernels/rays.h"

#include <vector>

namespace razor::test {

class Oracle {
public:
    /// `fused`: whether the target's fused multiply-add rounds once (all but sse4).
    Oracle(Frame& frame, bool fused);
    /// Of these triangles; origins of the frame's instances.
    Oracle(std::vector<Triangle> triangles, std::vector<Point> origins, bool fused);

    Hit closest(const Ray& ray) const;
    /// Triangles met, each one counted.
    int crossings(const Ray& ray) const;
    /// Whether a point is inside: an odd number of crossings in three directions. Unlikely ones that disagree
    /// are not inside.
    bool inside(const Point& p) const;
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Point>& origins() const { return origins_; }

private:
    template <class Visit> void each_hit(const Ray& ray, Visit visit) const;
    std::vector<Triangle> triangles_;
    std::vector<Point> origins_;
    bool fused_;
};

} // namespace razor::test
