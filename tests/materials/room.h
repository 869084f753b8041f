// A room of few polygons, and what may stand in it.
#pragma once

#include "razor/scene/scene.h"

namespace razor::test {

inline constexpr int room_size = 24; // pixels of its pictures, both ways

/// A floor and two walls, of the first three materials, a light above and a sky.
Scene room();

/// With all that surfaces can be of: textures, a normal map, a coat, metal, glass; and a map of the sky.
Scene full_room();

Material named(const char* name, const glm::vec3& albedo);
Mesh quad(const char* name, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int material);
/// Turned about its upright axis.
Mesh box(const char* name, const glm::dvec3& low, const glm::dvec3& edges, double degrees, int material);
/// Of triangles, 8 around and 4 high.
Mesh ball(const char* name, const glm::dvec3& middle, double radius, int material);

} // namespace razor::test
