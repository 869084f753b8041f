// What of a scene moves, and how: keys of objects, of the camera and of lights.
#pragma once

#include "razor/scene/animation/track.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

namespace razor {

/// Each takes the place of what stands still, where it has keys.
struct TransformKeys {
    Timing timing;
    Track<glm::dvec3> scale, rotate, translate; // as of Transform; rotate: each angle by itself

    bool any() const { return !scale.empty() || !rotate.empty() || !translate.empty(); }
    bool operator==(const TransformKeys&) const = default;
};

/// Of those that a camera of its projection has.
struct CameraKeys {
    Projection projection = Projection::perspective;
    Timing timing;
    Track<glm::dvec3> position, target, up;
    Track<double> fov, height, aperture_radius, focus_distance;

    bool any() const {
        return !position.empty() || !target.empty() || !up.empty() || !fov.empty() || !height.empty() ||
               !aperture_radius.empty() || !focus_distance.empty();
    }
    bool operator==(const CameraKeys&) const = default;
};

/// Of those that a light of its kind has (light_fields.h).
struct LightKeys {
    LightKind kind = LightKind::rectangle;
    Timing timing;
    Track<glm::dvec3> corner, edge_u, edge_v, radiance, position, direction;
    Track<double> radius, cone_angle, cone_delta, angular_radius;

    bool any() const {
        bool some = false;
        visit_light_fields(
            kind, [&](auto, auto, auto, const auto& track) { some |= !track.empty(); }, *this);
        return some;
    }
    bool operator==(const LightKeys&) const = default;
};

} // namespace razor
