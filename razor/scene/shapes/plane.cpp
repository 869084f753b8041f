#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 4> parameters{{
    {"width", 2, 1e-30, 1e30, false}, // along x
    {"depth", 2, 1e-30, 1e30, false}, // along z
    {"columns", 1, 1, 1000, true},
    {"rows", 1, 1, 1000, true},
}};

Mesh make(std::span<const double> values) {
    const int columns = static_cast<int>(values[2]);
    const int rows = static_cast<int>(values[3]);
    CageBuilder cage;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            cage.point(values[0] * (double(i) / columns - 0.5), 0, values[1] * (double(j) / rows - 0.5));
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int corner = j * (columns + 1) + i;
            const double left = double(i) / columns, right = double(i + 1) / columns;
            const double far = 1 - double(j) / rows, near = 1 - double(j + 1) / rows;
            cage.face({corner, corner + columns + 1, corner + columns + 2, corner + 1},
                      {{left, far}, {left, near}, {right, near}, {right, far}});
        }
    }
    return cage.take();
}

} // namespace

ShapeKind plane_kind() {
    return {"plane", parameters, make};
}

} // namespace razor
