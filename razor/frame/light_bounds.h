// Where lights are and where they shine, one or many together: what pbrt-4's LightBounds hold.
#pragma once

#include "razor/scene/graph/box.h"
#include "razor/scene/light.h"

#include <glm/vec3.hpp>

#include <numbers>

namespace razor {

/// Directions within an angle of an axis; all of them as it is.
struct NormalCone {
    glm::dvec3 axis{0, 0, 1};
    double angle = std::numbers::pi;
};

/// What is known of lights that are chosen together.
struct LightBounds {
    Box box; // scene coordinates
    NormalCone normals;
    double emission = 0; // angle from a normal
    double power = 0;    // by how bright each is along its normal; 0: there is none

    void add(const LightBounds& b);
};

/// Whether a light is somewhere: others are not chosen from, but each sampled.
bool has_place(const Light& light);

/// Of a light that has a place. `origin`: of scene coordinates.
LightBounds bounds_of(const Light& light, const glm::dvec3& origin);

} // namespace razor
