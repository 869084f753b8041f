// Cages of turned things: a profile revolved about the y axis.
#pragma once

#include "razor/scene/scene.h"

#include <span>

namespace razor {

/// One ring of a turned cage.
struct ProfilePoint {
    double radius = 0; // 0 at an end of the profile: a pole, met by triangles
    double height = 0;
    double sharpness = 0; // of the ring's edges
};

/// The profile runs upwards where the outside faces away from the axis. A profile that starts off the axis is
/// closed there by one n-gon facing down; one that ends off the axis stays open.
Mesh revolve(std::span<const ProfilePoint> profile, int segments);

} // namespace razor
