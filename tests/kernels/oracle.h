// Closest hits by brute force over every triangle of a frame: plain scalar code that shares nothing with the
// kernels but the order of its single-precision operations (Woop, Benthin & Wald, JCGT 2013), so that hits
// can be compared bit for bit.
#pragma once

#include "tests/kernels/rays.h"

#include <vector>

namespace razor::test {

/// Axes that kernels shear these rays along when they trace them in packets of `width`, in order: rays go in
/// groups, each along the largest component of its first ray, with all that have half of their own largest
/// there.
std::vector<int> shear_axes(const std::vector<Ray>& rays, int width);

class Oracle {
public:
    /// `fused`: whether the target's fused multiply-add rounds once (all but sse4).
    Oracle(Frame& frame, bool fused);
    /// Of these triangles; origins of the frame's instances.
    Oracle(std::vector<Triangle> triangles, std::vector<Point> origins, bool fused);

    Hit closest(const Ray& ray) const;
    /// Sheared along this axis, of which its last bits depend.
    Hit closest(const Ray& ray, int axis) const;
    /// Triangles met, each one counted.
    int crossings(const Ray& ray) const;
    /// Whether a point is inside: an odd number of crossings in three directions. Unlikely ones that disagree
    /// are not inside.
    bool inside(const Point& p) const;
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Point>& origins() const { return origins_; }

private:
    template <class Visit> void each_hit(const Ray& ray, int axis, Visit visit) const;
    std::vector<Triangle> triangles_;
    std::vector<Point> origins_;
    bool fused_;
};

} // namespace razor::test
