#include "tests/materials/skies.h"

#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/shared_exponent.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor::test {

using glm::dvec3;
using std::numbers::pi;

Texture sky_texture(int width, int height, const std::function<glm::vec3(double, double)>& colour) {
    return rgba_texture(width, height, [&](double u, double v) { return glm::vec4(colour(u, v), 1); });
}

Texture rgba_texture(int width, int height, const std::function<glm::vec4(double, double)>& colour) {
    PyramidBuilder builder(width, height);
    for (int y = 0; y < height; ++y) {
        std::vector<glm::vec4> row;
        for (int x = 0; x < width; ++x)
            row.push_back(colour((x + 0.5) / width, (y + 0.5) / height));
        builder.add_row(row);
    }
    Texture t;
    t.name = "sky";
    t.linear = true;
    t.pyramid = std::make_shared<const TexturePyramid>(builder.finish());
    return t;
}

void set_sky(Scene& scene, Texture texture, double rotation) {
    scene.sky_map = {static_cast<int>(scene.textures.size()), rotation};
    scene.textures.push_back(std::move(texture));
}

dvec3 sky_radiance(const Scene& scene, const dvec3& d) {
    if (scene.sky_map.texture < 0)
        return scene.sky;
    const TextureLevel& level =
        scene.textures[static_cast<std::size_t>(scene.sky_map.texture)].pyramid->levels[0];
    const auto texel = [&](int x, int y) {
        x = (x % level.width + level.width) % level.width;
        y = std::clamp(y, 0, level.height - 1);
        const int tiles = (level.width + texel_tile - 1) / texel_tile;
        const int word = 16 * (y / 4 * tiles + x / 4) + 4 * (y % 4) + x % 4;
        return dvec3(unpack_shared_exponent(level.texels[static_cast<std::size_t>(word)]));
    };
    // Longitude from -z to x, as the picture has it after it was turned the other way.
    const double turned = std::atan2(d.x, -d.z) / (2 * pi) + scene.sky_map.rotation / 360 + 0.5;
    const double x = (turned - std::floor(turned)) * level.width - 0.5;
    const double y = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * level.height - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const dvec3 upper = glm::mix(texel(i, j), texel(i + 1, j), x - i);
    const dvec3 lower = glm::mix(texel(i, j + 1), texel(i + 1, j + 1), x - i);
    return dvec3(scene.sky) * glm::mix(upper, lower, y - j);
}

glm::vec3 morning(double u, double v, double radius, double brightness) {
    const auto direction = [](double across, double down) {
        return dvec3(std::sin(pi * down) * std::sin(2 * pi * across), std::cos(pi * down),
                     -std::sin(pi * down) * std::cos(2 * pi * across));
    };
    const double cosine = glm::dot(direction(u, v), direction(0.3, 0.25));
    const auto sun = static_cast<float>(cosine > std::cos(radius) ? brightness : 0);
    const auto side = static_cast<float>(0.5 + 0.5 * cosine), low = static_cast<float>(v);
    return glm::vec3(0.2F + side, 0.3F + 0.5F * side, 0.6F) * (1.2F - low) +
           glm::vec3(sun, 0.9F * sun, 0.7F * sun);
}

} // namespace razor::test
