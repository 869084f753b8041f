#include "tests/materials/texture_lookup.h"

#include "razor/scene/textures/shared_exponent.h"
#include "tests/kernels/targets.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace razor::test {

using glm::dvec2;
using glm::dvec3;

namespace {

std::size_t word_of(const TextureLevel& level, int x, int y) {
    return static_cast<std::size_t>(16 * (y / 4 * ((level.width + 3) / 4) + x / 4) + 4 * (y % 4) + x % 4);
}

TextureLevel level_of(int width, int height, const std::function<glm::vec3(int x, int y)>& colour) {
    TextureLevel level{width, height, {}, {}};
    level.texels.resize(static_cast<std::size_t>((width + 3) / 4 * ((height + 3) / 4) * 16));
    for (int y = 0; y < (height + 3) / 4 * 4; ++y)
        for (int x = 0; x < (width + 3) / 4 * 4; ++x)
            level.texels[word_of(level, x, y)] =
                pack_shared_exponent(colour(std::min(x, width - 1), std::min(y, height - 1)));
    return level;
}

/// Texel n of so many in a row that goes on as the texture wraps.
int wrapped(int n, int size, Wrap wrap) {
    if (wrap == Wrap::clamp)
        return std::clamp(n, 0, size - 1);
    const int period = wrap == Wrap::repeat ? size : 2 * size;
    n = (n % period + period) % period;
    return n < size ? n : 2 * size - 1 - n;
}

/// `texels`: the level's colours or opacity.
dvec3 bilinear_lookup(const Texture& t, std::size_t level, const std::vector<std::uint32_t>& texels,
                      const dvec2& at) {
    const TextureLevel& l = t.pyramid->levels[level];
    const double x = at.x * l.width - 0.5, y = (1 - at.y) * l.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    dvec3 sum(0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int column = wrapped(static_cast<int>(x0) + i, l.width, t.wrap_u);
            const int row = wrapped(static_cast<int>(y0) + j, l.height, t.wrap_v);
            const double share = (i == 0 ? 1 - (x - x0) : x - x0) * (j == 0 ? 1 - (y - y0) : y - y0);
            sum += share * dvec3(unpack_shared_exponent(texels[word_of(l, column, row)]));
        }
    return sum;
}

} // namespace

Texture random_texture(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    TexturePyramid pyramid;
    for (;; width = (width + 1) / 2, height = (height + 1) / 2) {
        std::vector<glm::vec3> texels;
        for (int i = 0; i < width * height; ++i) {
            const float r = next(), g = next(), b = next();
            texels.emplace_back(r, g, b);
        }
        pyramid.levels.push_back(level_of(
            width, height, [&](int x, int y) { return texels[static_cast<std::size_t>(y * width + x)]; }));
        if (width == 1 && height == 1)
            break;
    }
    Texture t;
    t.name = "random";
    t.pyramid = std::make_shared<const TexturePyramid>(std::move(pyramid));
    return t;
}

Texture plain_texture(const glm::vec3& colour) {
    Texture t;
    t.name = "plain";
    TexturePyramid pyramid;
    pyramid.levels.push_back(level_of(1, 1, [&](int, int) { return colour; }));
    t.pyramid = std::make_shared<const TexturePyramid>(std::move(pyramid));
    return t;
}

dvec3 colour_at(const Texture& t, const dvec2& at, double area) {
    const auto& levels = t.pyramid->levels;
    const double last = static_cast<double>(levels.size()) - 1;
    const double texels = area * levels[0].width * levels[0].height;
    const double level = std::clamp(0.5 * std::log2(std::max(texels, 1e-12)), 0.0, last);
    const double below = std::floor(level);
    const auto colour = [&](double number) {
        const auto n = static_cast<std::size_t>(number);
        return bilinear_lookup(t, n, levels[n].texels, at);
    };
    const dvec3 fine = colour(below), coarse = colour(std::min(below + 1, last));
    return fine + (level - below) * (coarse - fine);
}

double opacity_at(const Texture& t, const dvec2& at) {
    const std::vector<std::uint32_t>& opacity = t.pyramid->levels[0].opacity;
    return opacity.empty() ? 1 : bilinear_lookup(t, 0, opacity, at).x;
}

dvec2 mapped_by(const TextureMap& map, const dvec2& uv) {
    const dvec2 p = uv * dvec2(map.scale);
    const double c = std::cos(double{map.rotation}), s = std::sin(double{map.rotation});
    return {map.offset.x + c * p.x - s * p.y, map.offset.y + s * p.x + c * p.y};
}

Layout random_layout(std::mt19937& random) {
    const auto next = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    Layout l;
    do {
        l.linear = {{next(), next()}, {next(), next()}};
    } while (std::abs(glm::determinant(l.linear)) < 0.2);
    l.offset = {3 * next(), 3 * next()};
    return l;
}

Mesh laid_out(Mesh mesh, const Layout& layout) {
    mesh.texcoords.clear();
    for (const dvec3& p : mesh.points)
        mesh.texcoords.emplace_back(layout(p));
    mesh.face_texcoords = mesh.face_vertices;
    mesh.face_varying = FaceVaryingInterpolation::none;
    return mesh;
}

Mesh square(int n, Scheme scheme, const std::function<double(int, int)>& height) {
    Mesh m;
    m.name = "square";
    m.scheme = scheme;
    m.boundary = BoundaryInterpolation::edge_and_corner;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            m.points.emplace_back(-1 + 2.0 * i / n, height ? height(i, j) : 0, -1 + 2.0 * j / n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int p = j * (n + 1) + i;
            m.face_sizes.push_back(4);
            m.face_vertices.insert(m.face_vertices.end(), {p, p + n + 1, p + n + 2, p + 1});
        }
    m.edge_length = 0.125;
    return m;
}

Scene scene_with(const Mesh& mesh, const Texture& texture, const TextureMap& map) {
    Scene s = seen_floor({}, 0);
    s.meshes = {mesh};
    s.textures = {texture};
    s.materials[0].albedo = {1, 1, 1};
    s.materials[0].albedo_map = map;
    s.settings.width = s.settings.height = 1;
    s.settings.samples = 1;
    s.settings.lod = Lod::recursive;
    return s;
}

dvec3 three(const Film& film, const char* x, const char* y, const char* z, std::size_t pixel) {
    return {film.find(x)->values[pixel], film.find(y)->values[pixel], film.find(z)->values[pixel]};
}

Met meet(Scene& scene, const dvec3& from, const dvec3& target) {
    scene.camera.position = from;
    scene.camera.target = target;
    scene.camera.fov_degrees = pixel_degrees;
    RenderOptions options;
    options.threads = 1;
    options.isa = native_targets().back()->name;
    const Film film = render_native(scene, options).film;
    Met met;
    met.depth = film.find("depth.Z")->values[0];
    met.position = from + met.depth * glm::normalize(target - from);
    met.albedo = three(film, "albedo.R", "albedo.G", "albedo.B");
    met.normal = three(film, "normal.X", "normal.Y", "normal.Z");
    met.beauty = three(film, "R", "G", "B");
    return met;
}

void expect_near(const dvec3& a, const dvec3& b, double tolerance, const std::string& what) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(a[c], b[c], tolerance) << what << ", component " << c;
}

} // namespace razor::test
