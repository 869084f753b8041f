#include "razor/scene/graph/records.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

float below(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) <= x
               ? nearest
               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

float above(double x) {
    return -below(-x);
}

} // namespace

GraphNodeRecord pack(const HierarchyNode& node, const glm::dvec3& origin) {
    GraphNodeRecord record{};
    record.instance = node.instance;
    if (node.instance < 0 && node.child_count == 0) {
        return record;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double low = node.bounds.low[axis] - origin[axis];
        const double high = node.bounds.high[axis] - origin[axis];
        // More than control points, patches' boxes and grids can be off in single precision.
        const double slack = 2e-6 * std::max(std::abs(low), std::abs(high));
        record.low[axis] = below(low - slack);
        record.high[axis] = above(high + slack);
    }
    record.first_child = node.first_child;
    record.child_count = node.child_count;
    return record;
}

} // namespace razor
