#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 4> parameters{{
    {"petals", 6, 3, 1000, true},
    {"middle", 0.62, -10, 10, false}, // height of the middle
    {"ridge", 0.95, -10, 10, false},  // height of the outer ends of the seams between petals
    {"waist", 0.8, 0.05, 2, false},   // radius of those ends; the petals' tips lie on the ground at radius 1
}};

Mesh make(std::span<const double> values) {
    const int petals = static_cast<int>(values[0]);
    CageBuilder cage;
    const int middle = cage.point(0, values[1], 0);
    for (int i = 0; i < petals; ++i) {
        const double seam = 2 * std::numbers::pi * i / petals;
        const double tip = 2 * std::numbers::pi * (i + 0.5) / petals;
        cage.point(values[3] * std::sin(seam), values[2], values[3] * std::cos(seam));
        cage.point(std::sin(tip), 0, std::cos(tip));
    }
    for (int i = 0; i < petals; ++i) {
        const int seam = 1 + 2 * i;
        const int next = 1 + 2 * ((i + 1) % petals);
        cage.face({middle, seam, seam + 1, next});
    }
    return cage.take();
}

} // namespace

ShapeKind canopy_kind() {
    return {"canopy", parameters, make};
}

} // namespace razor
