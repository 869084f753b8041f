// Triangulation of a simple polygon in the plane by ear clipping (Meisters, "Polygons have ears", 1975).
// Corners may coincide (a hole joined to the outline by a bridge runs along it twice) and follow each other
// in a straight line.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <span>
#include <vector>

namespace razor {

/// Twice the signed area of a triangle, positive if counter-clockwise.
double doubled_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// Exactly size - 2 triangles of corner numbers that together use every side of the counter-clockwise polygon
/// once. None is clockwise if the polygon is simple; polygons that cross themselves give some covering, and
/// it ends always. O(n^2) as a rule, O(n^3) at worst.
std::vector<std::array<int, 3>> clip_ears(std::span<const glm::dvec2> polygon);

} // namespace razor
