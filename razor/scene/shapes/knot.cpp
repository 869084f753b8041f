#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 5> parameters{{
    {"segments", 48, 12, 10000, true},
    {"swing", 0.42, 0.05, 0.9, false},   // of the band to both sides of the unit circle
    {"width", 0.42, 1e-3, 1, false},     // of the section, along the torus that the knot winds about
    {"thickness", 0.20, 1e-3, 1, false}, // of the section, away from that torus
    {"sharpness", 1.6, 0, 10, false},    // of the band's four edges
}};

/// A point of the (2, 3) torus knot, t in [0, 2 pi).
glm::dvec3 knot(double t, double swing) {
    const double radius = 1 + swing * std::cos(3 * t);
    return {radius * std::sin(2 * t), swing * std::sin(3 * t), radius * std::cos(2 * t)};
}

Mesh make(std::span<const double> values) {
    const int segments = static_cast<int>(values[0]);
    const double swing = values[1];
    CageBuilder cage;
    for (int i = 0; i < segments; ++i) {
        const double t = 2 * std::numbers::pi * i / segments;
        const glm::dvec3 centre = knot(t, swing);
        const glm::dvec3 along = glm::normalize(knot(t + 1e-4, swing) - knot(t - 1e-4, swing));
        const glm::dvec3 core{std::sin(2 * t), 0, std::cos(2 * t)};
        const glm::dvec3 across = glm::normalize(glm::cross(along, centre - core));
        const glm::dvec3 away = glm::cross(across, along);
        const glm::dvec3 w = 0.5 * values[2] * across;
        const glm::dvec3 h = 0.5 * values[3] * away;
        cage.point(centre - w - h);
        cage.point(centre + w - h);
        cage.point(centre + w + h);
        cage.point(centre - w + h);
    }
    for (int i = 0; i < segments; ++i) {
        const int here = 4 * i;
        const int next = 4 * ((i + 1) % segments);
        for (int side = 0; side < 4; ++side) {
            const int other = (side + 1) % 4;
            const double from = double(i) / segments, to = double(i + 1) / segments;
            const double below = 0.25 * side, above = 0.25 * (side + 1);
            cage.face({here + side, next + side, next + other, here + other},
                      {{from, below}, {to, below}, {to, above}, {from, above}});
            cage.crease(here + side, next + side, values[4]);
        }
    }
    return cage.take();
}

} // namespace

ShapeKind knot_kind() {
    return {"knot", parameters, make};
}

} // namespace razor
