#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 4> parameters{{
    {"petals", 3, 1, 100, true},
    {"rings", 4, 1, 1000, true},
    {"rise", 0.45, -10, 10, false},
    {"wave", 0.3, -10, 10, false},
}};

Mesh make(std::span<const double> values) {
    const int petals = static_cast<int>(values[0]);
    const int rings = static_cast<int>(values[1]);
    const int segments = 4 * petals;
    CageBuilder cage;
    for (int ring = 1; ring <= rings; ++ring) {
        const double r = double(ring) / rings;
        for (int i = 0; i < segments; ++i) {
            const double angle = 2 * std::numbers::pi * i / segments;
            const double y = values[2] * r * r + values[3] * r * r * r * std::cos(petals * angle);
            cage.point(r * std::sin(angle), y, r * std::cos(angle));
        }
    }
    const auto seen_from_above = [&](int point) {
        const glm::dvec3& p = cage.points()[static_cast<std::size_t>(point)];
        return glm::dvec2(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.z);
    };
    const auto face = [&](const std::vector<int>& corners) {
        std::vector<glm::dvec2> coordinates;
        for (const int corner : corners) {
            coordinates.push_back(seen_from_above(corner));
        }
        cage.face(corners, coordinates);
    };
    std::vector<int> middle;
    for (int i = 0; i < segments; ++i) {
        middle.push_back(i);
    }
    face(middle);
    for (int ring = 1; ring < rings; ++ring) {
        for (int i = 0; i < segments; ++i) {
            const int j = (i + 1) % segments;
            const int inner = (ring - 1) * segments, outer = ring * segments;
            face({inner + i, outer + i, outer + j, inner + j});
        }
    }
    return cage.take();
}

} // namespace

ShapeKind dish_kind() {
    return {"dish", parameters, make};
}

} // namespace razor
