#include "tests/materials/plain_textures.h"

#include "tests/materials/plain_pattern.h"
#include "tests/materials/texture_lookup.h"

namespace razor::test {

using glm::dvec3;

dvec3 plain_colour(const Scene& scene, const TextureMap& map, const PlainPlace& at) {
    if (map.texture < 0)
        return dvec3(1);
    const Texture& texture = scene.textures[static_cast<std::size_t>(map.texture)];
    const glm::dvec2 on_map = mapped_by(map, at.texcoords);
    if (!texture.pattern)
        return colour_at(texture, on_map, 0);
    const Pattern& pattern = *texture.pattern;
    // Those of texture coordinates lie a quarter of a cell deep.
    const dvec3 q = pattern.space == PatternSpace::object
                        ? at.in_object / pattern.size
                        : dvec3(on_map.x / pattern.size, on_map.y / pattern.size, 0.25);
    return dvec3(pattern.low) + plain_value(pattern, q) * dvec3(pattern.high - pattern.low);
}

double plain_sheen_roughness(const Scene& scene, const TextureMap& map, const PlainPlace& at) {
    if (map.texture >= 0) {
        const Texture& texture = scene.textures[static_cast<std::size_t>(map.texture)];
        if (!texture.pattern && !texture.pyramid->levels[0].opacity.empty())
            return plain_opacity(texture, map, at.texcoords);
    }
    return plain_colour(scene, map, at).y;
}

double plain_opacity(const Texture& texture, const TextureMap& map, const glm::dvec2& texcoords) {
    return opacity_at(texture, mapped_by(map, texcoords));
}

} // namespace razor::test
