// Distances to points and boxes whose order survives rounding: each is made of the same operations, all of
// them monotone, so that no point of a box is computed to be nearer than the box, or further than its
// furthest. Without contraction to fused operations no slack is needed.
#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace razor::reference {

inline double length(const glm::dvec3& d) {
    return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

struct Box {
    glm::dvec3 low{1e300}, high{-1e300};

    bool empty() const { return low.x > high.x; }
    void include(const glm::dvec3& p) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    double nearest(const glm::dvec3& from) const {
        glm::dvec3 d;
        for (int k = 0; k < 3; ++k)
            d[k] = std::max({low[k] - from[k], from[k] - high[k], 0.0});
        return length(d);
    }
    double furthest(const glm::dvec3& from) const {
        glm::dvec3 d;
        for (int k = 0; k < 3; ++k)
            d[k] = std::max(std::abs(low[k] - from[k]), std::abs(high[k] - from[k]));
        return length(d);
    }
};

} // namespace razor::reference
