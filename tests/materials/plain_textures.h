// What textures make of points, in double: pictures at their finest level, patterns at points.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace razor::test {

/// A point of a surface, as textures know it.
struct PlainPlace {
    glm::dvec3 in_object;
    glm::dvec2 texcoords;
};

/// White where there is no map.
glm::dvec3 plain_colour(const Scene& scene, const TextureMap& map, const PlainPlace& at);

/// 1 where there is no map; of a picture that has opacity that, else green.
double plain_sheen_roughness(const Scene& scene, const TextureMap& map, const PlainPlace& at);

/// Of a picture.
double plain_opacity(const Texture& texture, const TextureMap& map, const glm::dvec2& texcoords);

} // namespace razor::test
