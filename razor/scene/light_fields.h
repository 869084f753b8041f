// The members of a light that mean something for its kind, by the names that scene files have for them.
#pragma once

#include "razor/scene/light.h"
#include "razor/scene/ranges.h"

#include <string_view>

namespace razor {

/// What Light::radiance is called.
constexpr std::string_view emission_name(LightKind kind) {
    switch (kind) {
    case LightKind::point:
    case LightKind::spot:
        return "intensity";
    case LightKind::directional:
        return "irradiance";
    default:
        return "radiance";
    }
}

/// Calls visit(name, range, whether one number stands for all three, member...) for each, the members being
/// those of Light, or tracks of the same names, of all `lights`.
template <class Visit, class... Lights>
void visit_light_fields(LightKind kind, Visit visit, Lights&... lights) {
    using enum LightKind;
    if (kind == rectangle) {
        visit("corner", coordinate_range, false, lights.corner...);
        visit("edge_u", coordinate_range, false, lights.edge_u...);
        visit("edge_v", coordinate_range, false, lights.edge_v...);
    } else if (kind != directional) {
        visit("position", coordinate_range, false, lights.position...);
    }
    if (kind == disk || kind == spot || kind == directional)
        visit("direction", coordinate_range, false, lights.direction...);
    if (kind == disk || kind == sphere)
        visit("radius", light_radius_range, false, lights.radius...);
    if (kind == spot) {
        visit("cone_angle", cone_range, false, lights.cone_angle...);
        visit("cone_delta", cone_range, false, lights.cone_delta...);
    }
    if (kind == directional)
        visit("angular_radius", angular_radius_range, false, lights.angular_radius...);
    const bool by_direction = kind == point || kind == spot;
    visit(emission_name(kind), by_direction ? intensity_range : radiance_range, true, lights.radiance...);
}

} // namespace razor
