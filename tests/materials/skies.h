// Skies that maps show, for tests, and the same by definition, in double.
#pragma once

#include "razor/scene/scene.h"

#include <functional>

namespace razor::test {

/// What a map of that many texels shows: colour(u, v), both in [0, 1], v from the top.
Texture sky_texture(int width, int height, const std::function<glm::vec3(double, double)>& colour);

/// The same with opacity.
Texture rgba_texture(int width, int height, const std::function<glm::vec4(double, double)>& colour);

/// Adds it to the scene as its sky.
void set_sky(Scene& scene, Texture texture, double rotation = 0);

/// The radiance from a unit direction: of the map's finest level, bilinear, or of the sky alone.
glm::dvec3 sky_radiance(const Scene& scene, const glm::dvec3& direction);

/// Bright on one side, with a bright disk of that radius in radians around (u, v) = (0.3, 0.25).
glm::vec3 morning(double u, double v, double radius, double brightness);

} // namespace razor::test
