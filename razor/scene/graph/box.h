// Axis-aligned boxes in double precision.
#pragma once

#include "razor/scene/graph/affine.h"

#include <glm/common.hpp>

#include <limits>
#include <span>

namespace razor {

/// Closed; holds nothing (low > high) until something is added.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};

    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const Box& box) {
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
    bool contains(const glm::dvec3& p) const {
        return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z &&
               p.z <= high.z;
    }
    bool contains(const Box& box) const { return box.empty() || (contains(box.low) && contains(box.high)); }
    glm::dvec3 centre() const { return low * 0.5 + high * 0.5; }
    bool operator==(const Box&) const = default;
};

/// Holds map(p) for every p in `box`, rounding included, and grows by 1/256 of its largest extent: as much
/// as the frame grows the boxes of patches, so that it holds those too, before they are rounded
/// (razor/kernels/refit.h).
Box bounds_of_image(const Affine& map, const Box& box);

/// The box of the points that faces use. A Catmull-Clark limit surface lies in their hull (subdivision masks
/// are convex), a bilinear patch in that of its corners.
Box bounds_of_used_points(std::span<const glm::dvec3> points, std::span<const int> face_vertices);

} // namespace razor
