#include "razor/scene/shapes/kinds.h"
#include "razor/scene/shapes/revolve.h"

#include <array>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 2> parameters{{
    {"segments", 10, 3, 1000, true}, {"sharpness", 3, 0, 10, false}, // of the foot's and the collar's rims
}};

Mesh make(std::span<const double> values) {
    const double s = values[1];
    const std::array<ProfilePoint, 15> profile{{
        {0.66, 0.00, s},
        {0.68, 0.14, s},
        {0.56, 0.20, s},
        {0.52, 0.30, 0},
        {0.33, 0.44, 0},
        {0.24, 0.80, 0},
        {0.21, 1.12, s},
        {0.42, 1.20, s},
        {0.42, 1.27, s},
        {0.22, 1.34, 0.5 * s},
        {0.34, 1.44, 0},
        {0.43, 1.64, 0},
        {0.38, 1.86, 0},
        {0.20, 1.99, 0},
        {0.00, 2.02, 0},
    }};
    return revolve(profile, static_cast<int>(values[0]));
}

} // namespace

ShapeKind pawn_kind() {
    return {"pawn", parameters, make};
}

} // namespace razor
