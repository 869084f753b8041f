#include "razor/scene/shapes/kinds.h"
#include "razor/scene/shapes/revolve.h"

#include <array>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 2> parameters{{
    {"segments", 12, 3, 1000, true}, {"sharpness", 2.5, 0, 10, false}, // of foot and lip
}};

Mesh make(std::span<const double> values) {
    const double s = values[1];
    const std::array<ProfilePoint, 12> profile{{
        {0.46, 0.00, s},
        {0.44, 0.08, s},
        {0.26, 0.14, 0},
        {0.24, 0.24, s},
        {0.56, 0.34, 0},
        {0.92, 0.62, 0},
        {1.04, 1.02, s},
        {0.97, 1.02, s},
        {0.84, 0.66, 0},
        {0.50, 0.42, 0},
        {0.20, 0.36, 0},
        {0.00, 0.35, 0},
    }};
    return revolve(profile, static_cast<int>(values[0]));
}

} // namespace

ShapeKind bowl_kind() {
    return {"bowl", parameters, make};
}

} // namespace razor
