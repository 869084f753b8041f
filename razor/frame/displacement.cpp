#include "razor/frame/displacement.h"

#include "razor/scene/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

/// Lengths that leave room for sums and products in single precision.
constexpr double most_displacement = 1e30;

std::size_t word_of(const TextureLevel& level, int x, int y) {
    const int columns = (level.width + texel_tile - 1) / texel_tile;
    return static_cast<std::size_t>(16 * (y / 4 * columns + x / 4) + 4 * (y % 4) + x % 4);
}

double height_at(const TextureLevel& level, int x, int y) {
    return double{std::bit_cast<float>(level.texels[word_of(level, x, y)])};
}

/// The same in single precision, no less.
float rounded_up(double x) {
    return static_cast<float>(x * (1 + 1e-6));
}

/// How fast a pattern's values change per cell (razor/kernels/pattern_value.h), at most, whatever it is seen
/// through.
glm::dvec2 steepest(const Pattern& p) {
    // Of noise along an axis: its weights change by 15/8 at most while what they weigh differs by 2, and what
    // they weigh changes by 1.
    constexpr double of_noise = 2 * 1.875 + 1, lacunarity = 1.99;
    double octaves = 0, height = 1;
    for (int k = 0; k < p.octaves; ++k) {
        octaves += of_noise * height;
        height *= double{p.gain} * lacunarity;
    }
    const double bent = std::abs(double{p.amount}) * octaves, wave = std::numbers::pi;
    switch (p.kind) {
    case PatternKind::checker:
    case PatternKind::bricks:
        break;
    case PatternKind::noise:
        return glm::dvec2(octaves / 2);
    case PatternKind::turbulence:
        return glm::dvec2(octaves);
    case PatternKind::marble:
        return wave * glm::dvec2(1 + bent, bent);
    case PatternKind::wood:
        return wave * glm::dvec2(1 + bent / 4, bent / 4);
    }
    constexpr double step = 1e18; // no more than from the least height to the most
    return glm::dvec2(step);
}

} // namespace

double displacement_bound(const Scene& scene, int material) {
    if (material < 0 || static_cast<std::size_t>(material) >= scene.materials.size())
        return 0;
    const Material& m = scene.materials[static_cast<std::size_t>(material)];
    if (!is_displaced(m))
        return 0;
    const Texture& texture = scene.textures[static_cast<std::size_t>(m.displacement_map.texture)];
    if (texture.heights == nullptr && !texture.pattern)
        throw UserError(fmt::format("{}: material '{}' is displaced by texture '{}', whose heights were not "
                                    "read; read them with the texture",
                                    scene.name, m.name, texture.name));
    const double scale = std::abs(double{m.displacement_scale});
    if (texture.pattern && texture.pattern->space == PatternSpace::object)
        throw UserError(
            fmt::format("{}: material '{}' is displaced by texture '{}', a pattern of points, which "
                        "displacement would move; make it one of texture coordinates",
                        scene.name, m.name, texture.name));
    const HeightRange heights = height_range(texture);
    const double least = double{heights.least} - double{m.displacement_midlevel};
    const double most = double{heights.most} - double{m.displacement_midlevel};
    // Means and their interpolation are rounded.
    const double size = std::max(std::abs(double{heights.least}), std::abs(double{heights.most})) +
                        std::abs(double{m.displacement_midlevel});
    const double bound = scale * (std::max(std::abs(least), std::abs(most)) + 1e-5 * size);
    if (least == 0 && most == 0)
        return 0;
    if (!(bound <= most_displacement) || !(size <= most_displacement))
        throw UserError(fmt::format("{}: material '{}' is displaced by up to {:.3g}, which is too far; use a "
                                    "smaller displacement_scale, or smaller heights",
                                    scene.name, m.name, bound));
    return bound;
}

double displacement_bound(const Scene& scene, int mesh, int material) {
    if (material >= 0)
        return displacement_bound(scene, material);
    const Mesh& m = scene.meshes[static_cast<std::size_t>(mesh)];
    if (m.face_materials.empty())
        return displacement_bound(scene, m.material);
    double most = 0;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (is_displaced(scene.materials[i]) && std::find(m.face_materials.begin(), m.face_materials.end(),
                                                          static_cast<int>(i)) != m.face_materials.end())
            most = std::max(most, displacement_bound(scene, static_cast<int>(i)));
    return most;
}

std::vector<double> displacement_bounds(const Scene& scene) {
    std::vector<double> most(scene.meshes.size(), 0.0);
    if (std::none_of(scene.materials.begin(), scene.materials.end(), is_displaced))
        return most;
    // Who has which material, the graph says; bounds do not matter for that.
    std::vector<Box> bounds;
    for (const Mesh& mesh : scene.meshes)
        bounds.push_back(bounds_of_used_points(mesh.points, mesh.face_vertices));
    for (const FlatInstance& i : lay_out(scene, bounds).instances) {
        double& bound = most[static_cast<std::size_t>(i.mesh)];
        bound = std::max(bound, displacement_bound(scene, i.mesh, i.material));
    }
    return most;
}

Box displaced_bounds(const Mesh& mesh, double bound) {
    Box box = bounds_of_used_points(mesh.points, mesh.face_vertices);
    box.low -= glm::dvec3(bound);
    box.high += glm::dvec3(bound);
    return box;
}

void measure_texture_density(const Mesh& mesh, std::span<float> of_faces) {
    std::size_t first = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        const auto n = static_cast<std::size_t>(mesh.face_sizes[f]);
        const auto point = [&](std::size_t k) {
            return mesh.points[static_cast<std::size_t>(mesh.face_vertices[first + k])];
        };
        const auto coordinate = [&](std::size_t k) {
            const int at = mesh.face_texcoords[first + k];
            return at < 0 ? glm::dvec2(0) : glm::dvec2(mesh.texcoords[static_cast<std::size_t>(at)]);
        };
        glm::dvec3 area(0);
        double texture_area = 0;
        for (std::size_t k = 1; k + 1 < n; ++k) {
            area += glm::cross(point(k) - point(0), point(k + 1) - point(0));
            const glm::dvec2 a = coordinate(k) - coordinate(0), b = coordinate(k + 1) - coordinate(0);
            texture_area += a.x * b.y - a.y * b.x;
        }
        const double density = std::abs(texture_area) / glm::length(area);
        of_faces[f] = std::isfinite(density) ? static_cast<float>(std::min(density, 1e30)) : 0.0F;
        first += n;
    }
}

HeightRange height_range(const Texture& texture) {
    if (texture.pattern) {
        const float low = texture.pattern->low.x, high = texture.pattern->high.x;
        return {std::min(low, high), std::max(low, high)};
    }
    return {texture.heights->least, texture.heights->most};
}

std::vector<HeightSlopes> height_slopes(const Texture& texture) {
    if (texture.pattern) {
        const HeightRange range = height_range(texture);
        const glm::dvec2 slope =
            steepest(*texture.pattern) * ((double{range.most} - range.least) / texture.pattern->size);
        return {{rounded_up(std::min(slope.x, 1e30)), rounded_up(std::min(slope.y, 1e30))}};
    }
    std::vector<HeightSlopes> slopes;
    for (const TextureLevel& level : texture.heights->levels) {
        double u = 0, v = 0;
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x) {
                const double here = height_at(level, x, y);
                if (x + 1 < level.width || texture.wrap_u == Wrap::repeat)
                    u = std::max(u, std::abs(height_at(level, (x + 1) % level.width, y) - here));
                if (y + 1 < level.height || texture.wrap_v == Wrap::repeat)
                    v = std::max(v, std::abs(height_at(level, x, (y + 1) % level.height) - here));
            }
        slopes.push_back({rounded_up(u * level.width), rounded_up(v * level.height)});
    }
    return slopes;
}

} // namespace razor
