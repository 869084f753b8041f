#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 4> parameters{{
    {"width", 2, 1e-6, 1e9, false},
    {"height", 2, 1e-6, 1e9, false},
    {"depth", 2, 1e-6, 1e9, false},
    {"sharpness", 2.5, 0, 10, false},
}};

/// A side's corners in a net of the box, counter-clockwise from its lower left: each side is a texture.
std::vector<glm::dvec2> square(double u, double v) {
    return {{u, v}, {u + 1, v}, {u + 1, v + 1}, {u, v + 1}};
}

/// Corner c lies at x = bit 0, y = bit 1, z = bit 2 of c.
Mesh make(std::span<const double> values) {
    CageBuilder cage;
    for (int c = 0; c < 8; ++c) {
        cage.point(values[0] * ((c & 1) - 0.5), values[1] * ((c >> 1 & 1) - 0.5),
                   values[2] * ((c >> 2) - 0.5));
    }
    // Four sides in a row, the bottom below and the top above the one that faces z.
    cage.face({0, 4, 6, 2}, square(-1, 0));
    cage.face({1, 3, 7, 5}, {{2, 0}, {2, 1}, {1, 1}, {1, 0}});
    cage.face({0, 1, 5, 4}, square(0, -1));
    cage.face({2, 6, 7, 3}, {{0, 2}, {0, 1}, {1, 1}, {1, 2}});
    cage.face({0, 2, 3, 1}, {{3, 0}, {3, 1}, {2, 1}, {2, 0}});
    cage.face({4, 5, 7, 6}, square(0, 0));
    for (int c = 0; c < 8; ++c) {
        for (const int bit : {1, 2, 4}) {
            if ((c & bit) == 0) {
                cage.crease(c, c | bit, values[3]);
            }
        }
    }
    return cage.take();
}

} // namespace

ShapeKind box_kind() {
    return {"box", parameters, make};
}

} // namespace razor
