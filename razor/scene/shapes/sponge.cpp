#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>
#include <map>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 2> parameters{{
    {"strut", 0.6, 0.05, 0.95, false}, // thickness of the twelve struts, of the edge length 2
    {"sharpness", 0, 0, 10, false},    // of the twelve outer edges
}};

using Cell = std::array<int, 3>;

/// Cells 0 to 2 along each axis; a cell is solid unless two or three of its coordinates are the middle one.
bool solid(const Cell& cell) {
    int middles = 0;
    for (const int c : cell) {
        if (c < 0 || c > 2) {
            return false;
        }
        middles += c == 1 ? 1 : 0;
    }
    return middles < 2;
}

Mesh make(std::span<const double> values) {
    CageBuilder cage;
    const std::array<double, 4> planes{-1, -1 + values[0], 1 - values[0], 1};
    std::map<Cell, int> points;
    const auto point = [&](const Cell& at) {
        const auto found = points.find(at);
        if (found != points.end()) {
            return found->second;
        }
        return points[at] = cage.point(planes[std::size_t(at[0])], planes[std::size_t(at[1])],
                                       planes[std::size_t(at[2])]);
    };
    for (int number = 0; number < 27; ++number) {
        const Cell cell{number % 3, number / 3 % 3, number / 9};
        for (std::size_t axis = 0; axis < 3 && solid(cell); ++axis) {
            for (const int side : {0, 1}) {
                Cell beyond = cell;
                beyond[axis] += 2 * side - 1;
                if (solid(beyond)) {
                    continue;
                }
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                const auto corner = [&](int du, int dv) {
                    Cell at = cell;
                    at[axis] += side;
                    at[u] += du;
                    at[v] += dv;
                    return point(at);
                };
                const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                const auto at = [&](int p) { // from the other side u goes the other way
                    const glm::dvec3& q = cage.points()[static_cast<std::size_t>(p)];
                    return 0.5 + 0.5 * glm::dvec2((side == 1 ? 1 : -1) * q[static_cast<glm::length_t>(u)],
                                                  q[static_cast<glm::length_t>(v)]);
                };
                side == 1 ? cage.face({a, b, c, d}, {at(a), at(b), at(c), at(d)})
                          : cage.face({a, d, c, b}, {at(a), at(d), at(c), at(b)});
            }
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (int edge = 0; edge < 12; ++edge) { // three pieces of each of four edges
            Cell from{};
            from[axis] = edge % 3;
            from[(axis + 1) % 3] = edge / 3 % 2 * 3;
            from[(axis + 2) % 3] = edge / 6 * 3;
            Cell to = from;
            ++to[axis];
            cage.crease(point(from), point(to), values[1]);
        }
    }
    return cage.take();
}

} // namespace

ShapeKind sponge_kind() {
    return {"sponge", parameters, make};
}

} // namespace razor
