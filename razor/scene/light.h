// What lights a scene, of six kinds.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>

namespace razor {

enum class LightKind : std::uint8_t { rectangle, disk, sphere, point, spot, directional };

/// Which members mean something depends on the kind (light_fields.h); world units and angles in degrees.
struct Light {
    /// Of a rectangle: corner + s edge_u + t edge_v, s, t in [0, 1]; emits towards cross(edge_u, edge_v).
    glm::dvec3 corner{0}, edge_u{1, 0, 0}, edge_v{0, 0, 1};
    /// Linear RGB. Of rectangles, disks and spheres: radiance, W / (m^2 sr); of points and spots: radiant
    /// intensity, W / sr (of a spot on its axis); directional: irradiance of a surface that faces it, W /
    /// m^2.
    glm::vec3 radiance{1};
    LightKind kind = LightKind::rectangle;
    glm::dvec3 position{0}; // the middle of disks and spheres
    /// The side to which a disk emits, a spot's axis, the way that directional light travels; of any length.
    glm::dvec3 direction{0, -1, 0};
    double radius = 1; // of disks and spheres; spheres emit outwards
    /// A spot reaches so far from its axis, and is whole up to cone_delta within.
    double cone_angle = 30, cone_delta = 5;
    /// Of a directional light as it is seen, half its width: the sun's is 0.267; 0: shadows are sharp.
    double angular_radius = 0;
};

/// Whether all of its light comes from one point or one direction, so that one ray tells all of it.
inline bool is_delta(const Light& light) {
    return light.kind == LightKind::point || light.kind == LightKind::spot ||
           (light.kind == LightKind::directional && light.angular_radius == 0);
}

} // namespace razor
