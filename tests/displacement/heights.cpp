#include "tests/displacement/heights.h"

#include "razor/scene/textures/pyramid_builder.h"
#include "tests/kernels/cages.h"
#include "tests/materials/plain_pattern.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace razor::test {
namespace {

int wrapped(int n, int size, Wrap wrap) {
    if (wrap == Wrap::clamp)
        return std::clamp(n, 0, size - 1);
    const int period = wrap == Wrap::repeat ? size : 2 * size;
    n = (n % period + period) % period;
    return n < size ? n : 2 * size - 1 - n;
}

double bilinear(const Texture& t, std::size_t number, const glm::dvec2& at) {
    const TextureLevel& l = t.heights->levels[number];
    const double x = at.x * l.width - 0.5, y = (1 - at.y) * l.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    double sum = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int column = wrapped(static_cast<int>(x0) + i, l.width, t.wrap_u);
            const int row = wrapped(static_cast<int>(y0) + j, l.height, t.wrap_v);
            const auto word = static_cast<std::size_t>(16 * (row / 4 * ((l.width + 3) / 4) + column / 4) +
                                                       4 * (row % 4) + column % 4);
            sum += (i == 0 ? 1 - (x - x0) : x - x0) * (j == 0 ? 1 - (y - y0) : y - y0) *
                   double{std::bit_cast<float>(l.texels[word])};
        }
    return sum;
}

} // namespace

Texture height_texture(int width, int height, const std::function<float(int x, int y)>& value) {
    PyramidBuilder builder(width, height, Texels::heights), colours(1, 1);
    std::vector<glm::vec4> row(static_cast<std::size_t>(width), glm::vec4(0));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            row[static_cast<std::size_t>(x)].x = value(x, y);
        builder.add_row(row);
    }
    colours.add_row(std::vector<glm::vec4>{glm::vec4(1)});
    Texture t;
    t.name = "heights";
    t.pyramid = std::make_shared<const TexturePyramid>(colours.finish());
    t.heights = std::make_shared<const TexturePyramid>(builder.finish());
    return t;
}

Texture smooth_heights() {
    return height_texture(64, 64, [](int x, int y) {
        return 0.5F + 0.5F * std::sin(0.19634954F * static_cast<float>(x)) *
                          std::sin(0.19634954F * static_cast<float>(y));
    });
}

Texture random_heights() {
    std::mt19937 random(7);
    return height_texture(
        37, 21, [&](int, int) { return static_cast<float>(static_cast<double>(random()) / 4294967296.0); });
}

Texture stepped_heights() {
    return height_texture(64, 64, [](int x, int y) { return (x / 8 + y / 8) % 2 == 0 ? 0.0F : 1.0F; });
}

Texture constant_heights(float value) {
    return height_texture(4, 4, [=](int, int) { return value; });
}

Texture pattern_heights(PatternKind kind) {
    Pattern p;
    p.kind = kind;
    p.space = PatternSpace::texture;
    p.size = 0.7;
    p.octaves = 2;
    p.amount = kind == PatternKind::bricks ? 0.1F : 0.3F;
    p.low = glm::vec3(-0.5F);
    p.high = glm::vec3(1.5F);
    Texture t;
    t.name = "pattern";
    t.pattern = p;
    return t;
}

double lookup(const Texture& texture, const glm::dvec2& at, double level) {
    if (texture.pattern) {
        const Pattern& p = *texture.pattern;
        return glm::mix(double{p.low.x}, double{p.high.x}, plain_value(p, {at / p.size, 0.25}));
    }
    const double last = static_cast<double>(texture.heights->levels.size()) - 1;
    level = std::clamp(level, 0.0, last);
    const double below = std::floor(level);
    const double fine = bilinear(texture, static_cast<std::size_t>(below), at);
    const double coarse = bilinear(texture, static_cast<std::size_t>(std::min(below + 1, last)), at);
    return fine + (level - below) * (coarse - fine);
}

Mesh with_smooth_texcoords(Mesh mesh) {
    for (const glm::dvec3& p : mesh.points)
        mesh.texcoords.emplace_back(0.37 * p.x + 0.11 * p.y + 0.3, 0.41 * p.z - 0.23 * p.y + 0.2);
    mesh.face_texcoords = mesh.face_vertices;
    mesh.face_varying = FaceVaryingInterpolation::none;
    return mesh;
}

Mesh with_seams(Mesh mesh) {
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        const double n = mesh.face_sizes[f], turn = 0.7 * static_cast<double>(f);
        for (int k = 0; k < mesh.face_sizes[f]; ++k, ++corner) {
            const double angle = turn + 6.28318530718 * k / n;
            mesh.face_texcoords.push_back(static_cast<int>(mesh.texcoords.size()));
            mesh.texcoords.emplace_back(0.4 * std::cos(angle) + 0.31 * turn, 0.4 * std::sin(angle));
        }
    }
    mesh.face_varying = FaceVaryingInterpolation::all;
    return mesh;
}

Scene displaced_scene(const Mesh& mesh, double edges_across, const Texture& heights, double scale,
                      double midlevel) {
    Scene s = scene_of(mesh, edges_across);
    s.textures = {heights};
    s.materials[0].displacement_map.texture = 0;
    s.materials[0].displacement_scale = static_cast<float>(scale);
    s.materials[0].displacement_midlevel = static_cast<float>(midlevel);
    s.settings.lod = Lod::recursive;
    return s;
}

} // namespace razor::test
