#include "razor/scene/graph/box.h"

#include <algorithm>
#include <cmath>

namespace razor {

Box bounds_of_image(const Affine& map, const Box& box) {
    if (box.empty()) {
        return box;
    }
    // Arvo, "Transforming Axis-Aligned Bounding Boxes", Graphics Gems, 1990. Here and where a point is
    // mapped, three products and three sums are rounded: each is off by at most gamma(4) of the sum of sizes.
    constexpr double gamma = 16 * std::numeric_limits<double>::epsilon();
    Box image{map.translation, map.translation};
    glm::dvec3 size = glm::abs(map.translation);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            const double a = map.linear[column][row] * box.low[column];
            const double b = map.linear[column][row] * box.high[column];
            image.low[row] += std::min(a, b);
            image.high[row] += std::max(a, b);
            size[row] += std::max(std::abs(a), std::abs(b));
        }
    }
    const glm::dvec3 extent = image.high - image.low;
    const double growth = std::max({extent.x, extent.y, extent.z}) / 256;
    image.low -= glm::dvec3(growth) + gamma * size;
    image.high += glm::dvec3(growth) + gamma * size;
    return image;
}

Box bounds_of_used_points(std::span<const glm::dvec3> points, std::span<const int> face_vertices) {
    Box box;
    for (const int vertex : face_vertices) {
        box.add(points[static_cast<std::size_t>(vertex)]);
    }
    return box;
}

} // namespace razor
