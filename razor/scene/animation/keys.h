// What of a scene moves, and how: keys of objects, of the camera and of lights.
#pragma once

#include "razor/scene/animation/track.h"

#include <glm/vec3.hpp>

namespace razor {

/// Each takes the place of what stands still, where it has keys.
struct TransformKeys {
    Timing timing;
    Track<glm::dvec3> scale, rotate, translate; // as of Transform; rotate: each angle by itself

    bool any() const { return !scale.empty() || !rotate.empty() || !translate.empty(); }
    bool operator==(const TransformKeys&) const = default;
};

struct CameraKeys {
    Timing timing;
    Track<glm::dvec3> position, target, up;
    Track<double> fov, aperture_radius, focus_distance;

    bool any() const {
        return !position.empty() || !target.empty() || !up.empty() || !fov.empty() ||
               !aperture_radius.empty() || !focus_distance.empty();
    }
    bool operator==(const CameraKeys&) const = default;
};

struct LightKeys {
    Timing timing;
    Track<glm::dvec3> corner, edge_u, edge_v, radiance;

    bool any() const { return !corner.empty() || !edge_u.empty() || !edge_v.empty() || !radiance.empty(); }
    bool operator==(const LightKeys&) const = default;
};

} // namespace razor
