// Textures on floors: the albedo, and the normal, that one ray sees against lookups in double by what
// razor/scene/texture.h and material.h say, whatever the floor is made of.
#include "razor/scene/error.h"
#include "razor/scene/textures/shared_exponent.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace razor::test {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Of the one pixel; directions are rounded to about as much.
constexpr double pixel_degrees = 1e-5;

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

/// All levels random: no level stands for another.
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

/// Texel n of so many in a row that goes on as the texture wraps.
int wrapped(int n, int size, Wrap wrap) {
    if (wrap == Wrap::clamp)
        return std::clamp(n, 0, size - 1);
    const int period = wrap == Wrap::repeat ? size : 2 * size;
    n = (n % period + period) % period;
    return n < size ? n : 2 * size - 1 - n;
}

dvec3 bilinear_lookup(const Texture& t, std::size_t level, const dvec2& at) {
    const TextureLevel& l = t.pyramid->levels[level];
    const double x = at.x * l.width - 0.5, y = (1 - at.y) * l.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    dvec3 sum(0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int column = wrapped(static_cast<int>(x0) + i, l.width, t.wrap_u);
            const int row = wrapped(static_cast<int>(y0) + j, l.height, t.wrap_v);
            const double share = (i == 0 ? 1 - (x - x0) : x - x0) * (j == 0 ? 1 - (y - y0) : y - y0);
            sum += share * dvec3(unpack_shared_exponent(l.texels[word_of(l, column, row)]));
        }
    return sum;
}

/// `area`: in mapped texture coordinates, of what is asked for.
dvec3 lookup(const Texture& t, const dvec2& at, double area) {
    const auto& levels = t.pyramid->levels;
    const double last = static_cast<double>(levels.size()) - 1;
    const double texels = area * levels[0].width * levels[0].height;
    const double level = std::clamp(0.5 * std::log2(std::max(texels, 1e-12)), 0.0, last);
    const double below = std::floor(level);
    const dvec3 fine = bilinear_lookup(t, static_cast<std::size_t>(below), at);
    const dvec3 coarse = bilinear_lookup(t, static_cast<std::size_t>(std::min(below + 1, last)), at);
    return fine + (level - below) * (coarse - fine);
}

dvec2 mapped_by(const TextureMap& map, const dvec2& uv) {
    const dvec2 p = uv * dvec2(map.scale);
    const double c = std::cos(double{map.rotation}), s = std::sin(double{map.rotation});
    return {map.offset.x + c * p.x - s * p.y, map.offset.y + s * p.x + c * p.y};
}

/// Texture coordinates from x and z of a floor.
struct Layout {
    glm::dmat2 linear{1};
    dvec2 offset{0};
    dvec2 operator()(const dvec3& p) const { return linear * dvec2(p.x, p.z) + offset; }
};

Layout random_layout(std::mt19937& random) {
    const auto next = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    Layout l;
    do {
        l.linear = {{next(), next()}, {next(), next()}};
    } while (std::abs(glm::determinant(l.linear)) < 0.2);
    l.offset = {3 * next(), 3 * next()};
    return l;
}

/// Each of its points has a coordinate, by where it is. What corners and boundaries do is left alone.
Mesh laid_out(Mesh mesh, const Layout& layout) {
    mesh.texcoords.clear();
    for (const dvec3& p : mesh.points)
        mesh.texcoords.emplace_back(layout(p));
    mesh.face_texcoords = mesh.face_vertices;
    mesh.face_varying = FaceVaryingInterpolation::none;
    return mesh;
}

/// From -1 to 1 in x and z, of n x n faces seen from above; `height` of points inside.
Mesh square(int n, Scheme scheme, const std::function<double(int, int)>& height = {}) {
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

Scene scene_with(const Mesh& mesh, const Texture& texture, const TextureMap& map = {.texture = 0}) {
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

/// What one ray meets.
struct Met {
    dvec3 position, albedo, normal, beauty;
    double depth;
};

dvec3 three(const Film& film, const char* x, const char* y, const char* z, std::size_t pixel = 0) {
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

class Places {
public:
    explicit Places(unsigned seed) : random(seed) {}
    double next() { return static_cast<double>(random()) / 2147483648.0 - 1.0; }
    dvec3 on(double extent) {
        const double x = extent * next(), z = extent * next();
        return {x, 0, z};
    }
    /// At most so many degrees from upright.
    dvec3 above(double degrees) {
        const double a = std::cos(glm::radians(degrees)), y = a + (1 - a) * std::abs(next());
        const double phi = 3.14159 * next(), s = std::sqrt(1 - y * y);
        return {s * std::cos(phi), y, s * std::sin(phi)};
    }
    std::mt19937 random;
};

TEST(Textures, AreTrilinearByWhatRaysAskFor) {
    Places places(3);
    double finest = 1e9, coarsest = -1e9;
    for (int n = 0; n < 240; ++n) {
        Texture texture = random_texture(n % 3 == 0   ? 13
                                         : n % 3 == 1 ? 64
                                                      : 16,
                                         n % 5 == 0 ? 6 : 16, 100U + unsigned(n));
        texture.wrap_u = static_cast<Wrap>(n % 3);
        texture.wrap_v = static_cast<Wrap>(n / 3 % 3);
        TextureMap map{.texture = 0};
        if (n % 2 == 0) {
            map.scale = {1.5 * places.next() + 0.1, 2.3};
            map.offset = {places.next(), places.next()};
            map.rotation = static_cast<float>(3 * places.next());
        }
        const Layout layout = random_layout(places.random);
        Scene scene = scene_with(laid_out(square(1, Scheme::bilinear), layout), texture, map);
        if (n % 4 == 1) // one level of geometry, yet textures are filtered
            scene.settings.lod = Lod::fixed;
        const dvec3 target = places.on(0.9), toward = places.above(86);
        const double distance = 3 + 2 * places.next();
        const double footprint = 2 * std::tan(glm::radians(pixel_degrees / 2));
        const double asked = std::exp2(-3 + 4 * places.next()) * 0.5; // edge length at the hit
        scene.settings.edge_pixels = asked / distance / footprint;
        if (asked / distance > 0.12) // what is asked for grows no faster than some bound
            continue;
        const Met met = meet(scene, target + distance * toward, target);
        const double area = asked * asked / toward.y * std::abs(glm::determinant(layout.linear)) *
                            std::abs(double{map.scale.x} * map.scale.y);
        const double level =
            0.5 * std::log2(area * texture.pyramid->levels[0].width * texture.pyramid->levels[0].height);
        finest = std::min(finest, level);
        coarsest = std::max(coarsest, level);
        expect_near(met.albedo, lookup(texture, mapped_by(map, layout(target)), area), 1e-4 + 5e-5 / toward.y,
                    fmt::format("place {}, level {}", n, level));
    }
    EXPECT_LT(finest, -1);
    EXPECT_GT(coarsest, 4);
}

/// Whatever the surface is made of, where it is hit it has the coordinates of that place.
void expect_coordinates_of_places(const Mesh& mesh, double extent) {
    Places places(5);
    int hits = 0;
    for (int n = 0; n < 24; ++n) {
        const Layout layout = random_layout(places.random);
        const Texture texture = random_texture(7, 5, 900U + unsigned(n));
        Scene scene = scene_with(laid_out(mesh, layout), texture);
        scene.settings.edge_pixels = 1e-3 / 4 / (2 * std::tan(glm::radians(pixel_degrees / 2)));
        const dvec3 target = places.on(extent);
        const Met met = meet(scene, target + 4.0 * places.above(50), target);
        if (!std::isfinite(met.depth))
            continue;
        ++hits;
        expect_near(met.albedo, lookup(texture, layout(met.position), 0), 3e-3,
                    fmt::format("{}, place {}", mesh.name, n));
    }
    EXPECT_GT(hits, 8) << mesh.name;
}

TEST(Textures, LieAlikeOnPatchesOfEveryKind) {
    const auto waves = [](int i, int j) { return 0.2 * std::sin(2.0 * i + 3.0 * j); };
    for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark})
        for (const int n : {1, 2, 5}) {
            Mesh flat = square(n, scheme), wavy = square(n, scheme, waves);
            flat.name = fmt::format("flat {}, {}", n, static_cast<int>(scheme));
            wavy.name = fmt::format("wavy {}, {}", n, static_cast<int>(scheme));
            expect_coordinates_of_places(flat, 0.6);
            expect_coordinates_of_places(wavy, 0.6);
        }
}

TEST(Textures, LieOnPolygonsByTheirCorners) {
    // An arrow's head, concave at its fourth corner; a star of ten corners; a pentagon that is not planar.
    Mesh arrow;
    arrow.scheme = Scheme::bilinear;
    arrow.name = "arrow";
    arrow.points = {{-0.9, 0, 0.8}, {0.9, 0, 0.7}, {0.1, 0, -0.9}, {0, 0, 0.2}};
    arrow.face_sizes = {4};
    arrow.face_vertices = {0, 1, 2, 3};
    arrow.edge_length = 0.1;
    Mesh star = arrow, ring = arrow;
    star.name = "star";
    ring.name = "pentagon";
    star.points.clear();
    ring.points.clear();
    star.face_vertices.clear();
    ring.face_vertices.clear();
    for (int k = 0; k < 10; ++k) {
        const double angle = -0.6283 * k, radius = k % 2 == 0 ? 1 : 0.6;
        star.points.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
        star.face_vertices.push_back(k);
    }
    for (int k = 0; k < 5; ++k) {
        const double angle = -1.2566 * k;
        ring.points.emplace_back(std::cos(angle), k % 2 == 0 ? 0.2 : -0.1, std::sin(angle));
        ring.face_vertices.push_back(k);
    }
    star.face_sizes = {10};
    ring.face_sizes = {5};
    for (const Mesh& mesh : {arrow, star, ring})
        expect_coordinates_of_places(mesh, 0.7);
    Mesh smooth = ring;
    smooth.name = "smooth pentagon";
    smooth.scheme = Scheme::catmull_clark;
    smooth.boundary = BoundaryInterpolation::edge_and_corner;
    expect_coordinates_of_places(smooth, 0.6);
}

Scene colourful(const Mesh& mesh) {
    Scene s = scene_with(mesh, plain_texture({0.5F, 0.25F, 1}));
    s.textures.push_back(plain_texture({0.125F, 1, 0.5F}));
    s.materials.resize(4, s.materials[0]);
    s.materials[1].albedo_map.texture = 1;
    s.materials[2].albedo_map.texture = -1;
    s.materials[2].albedo = {0.1F, 0.2F, 0.3F};
    s.materials[3].albedo = {0.5F, 0.5F, 1};
    return s;
}
constexpr dvec3 colours[] = {{0.5, 0.25, 1}, {0.125, 1, 0.5}, {0.1, 0.2, 0.3}, {0.25, 0.125, 1}};

TEST(Textures, FacesHaveTheirOwnMaterials) {
    for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark}) {
        Mesh mesh = laid_out(square(4, scheme), {});
        std::mt19937 random(17);
        for (int f = 0; f < 16; ++f)
            mesh.face_materials.push_back(static_cast<int>(random() % 4));
        Scene scene = colourful(mesh);
        for (const int own : {-1, 0, 1, 2, 3}) {
            if (own >= 0) // of the instance: goes before those of faces
                scene.graph.groups = {
                    {"scene", {{.name = "square", .mesh = 0, .local = {}, .material = own}}}};
            for (int f = 0; f < 16; f += own < 0 ? 1 : 5) {
                const dvec3 middle{-0.75 + f % 4 * 0.5, 0, -0.75 + f / 4 * 0.5};
                const int expected = own < 0 ? mesh.face_materials[static_cast<std::size_t>(f)] : own;
                expect_near(meet(scene, middle + dvec3(0.3, 3, 0.2), middle).albedo, colours[expected], 1e-6,
                            fmt::format("face {}, instance {}", f, own));
            }
        }
    }
}

// One packet meets faces of four materials with two textures, each pixel one face.
TEST(Textures, AreApartWithinAPacket) {
    for (const Lod lod : {Lod::recursive, Lod::fixed}) {
        Mesh mesh = laid_out(square(8, Scheme::bilinear), {});
        std::mt19937 random(19);
        for (int f = 0; f < 64; ++f)
            mesh.face_materials.push_back(static_cast<int>(random() % 4));
        Scene scene = colourful(mesh);
        scene.settings.lod = lod;
        scene.settings.width = scene.settings.height = 8;
        scene.camera.position = {0, 10, 0};
        scene.camera.target = {0, 0, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.fov_degrees = 2 * glm::degrees(std::atan(0.1));
        for (const KernelTable* target : native_targets()) {
            RenderOptions options;
            options.threads = 1;
            options.isa = target->name;
            const Film film = render_native(scene, options).film;
            for (std::size_t p = 0; p < 64; ++p)
                expect_near(three(film, "albedo.R", "albedo.G", "albedo.B", p),
                            colours[mesh.face_materials[p]], 1e-6, fmt::format("pixel {}", p));
        }
    }
}

// An instance that has a material of its own lies over one whose faces have theirs.
TEST(Textures, FacesAndInstancesAreApartWithinAPacket) {
    Mesh mesh = laid_out(square(8, Scheme::bilinear), {});
    std::mt19937 random(29);
    for (int f = 0; f < 64; ++f)
        mesh.face_materials.push_back(static_cast<int>(random() % 3));
    Scene scene = colourful(mesh);
    Transform above{.scale = {0.5, 1, 1}, .translate = {0.25, 1e-3, 0}};
    scene.graph.groups = {{"scene",
                           {{.name = "faces", .mesh = 0, .local = {}},
                            {.name = "own", .mesh = 0, .local = above, .material = 3}}}};
    scene.settings.width = scene.settings.height = 8;
    scene.camera.position = {0, 10, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.fov_degrees = 2 * glm::degrees(std::atan(0.1));
    for (const KernelTable* target : native_targets()) {
        RenderOptions options;
        options.threads = 1;
        options.isa = target->name;
        const Film film = render_native(scene, options).film;
        for (std::size_t p = 0; p < 64; ++p) {
            if (p % 8 == 2 || p % 8 == 7) // the edge of what lies above, nearly
                continue;
            const bool own = p % 8 >= 3;
            expect_near(three(film, "albedo.R", "albedo.G", "albedo.B", p),
                        colours[own ? 3 : mesh.face_materials[p]], 1e-6, fmt::format("pixel {}", p));
        }
    }
}

// Maps of one colour are factors: of colours all three, of metallic the blue, of roughness the green.
TEST(Textures, MultiplyWhatMaterialsSay) {
    Mesh mesh = laid_out(square(2, Scheme::catmull_clark), {});
    Scene scene = scene_with(mesh, plain_texture({0.5F, 0.25F, 0.75F}));
    Material& m = scene.materials[0];
    m.albedo = {0.8F, 0.6F, 0.4F};
    m.emission = {0.4F, 0.2F, 0.1F};
    m.metallic = 0.8F;
    m.roughness = 1;
    m.specular = 1;
    m.emission_map = m.metallic_map = m.roughness_map = m.albedo_map;
    scene.sky = {0.5F, 1, 0.7F};
    scene.settings.width = scene.settings.height = 8;
    scene.settings.samples = 16;
    scene.camera.position = {1, 3, 2};
    scene.camera.fov_degrees = 10;
    const auto seen = [&] {
        RenderOptions options;
        options.threads = 1;
        return render_native(scene, options).film;
    };
    const Film mapped = seen();
    m.albedo = {0.4F, 0.15F, 0.3F};
    m.emission = {0.2F, 0.05F, 0.075F};
    m.metallic = 0.8F * 0.75F;
    m.roughness = 0.25F;
    m.emission_map = m.metallic_map = m.roughness_map = m.albedo_map = {};
    const Film plain = seen();
    for (const Plane& plane : plain.planes)
        for (std::size_t p = 0; p < plane.values.size(); ++p)
            EXPECT_NEAR(mapped.find(plane.name)->values[p], plane.values[p], 1e-4) << plane.name << ' ' << p;
}

TEST(Textures, NormalMapsGoWithInstances) {
    const dvec3 tilt = glm::normalize(dvec3(0.5, 0.25, 0.8));
    for (const bool mirrored : {false, true})
        for (const bool below : {false, true}) {
            Layout layout;
            layout.linear = glm::dmat2(dvec2(0, 2), dvec2(2, 0)); // u along z, v along x
            Scene scene = scene_with(laid_out(square(3, Scheme::catmull_clark), layout),
                                     plain_texture(glm::vec3(tilt * 0.5 + 0.5)));
            scene.materials[0].normal_map = scene.materials[0].albedo_map;
            Transform local{.scale = {mirrored ? -1.0 : 1.0, 1, 1}, .rotate = {0, 30, 0}};
            scene.graph.groups = {{"scene", {{.name = "square", .mesh = 0, .local = local}}}};
            const glm::dmat3 turn = to_affine(local).linear;
            dvec3 expected = turn * glm::normalize(dvec3(tilt.y, tilt.z, tilt.x));
            if (below)
                expected = -expected;
            const dvec3 from(0.1, below ? -3 : 3, 0.2);
            expect_near(meet(scene, from, {0.1, 0, 0.07}).normal, expected, 5e-3,
                        fmt::format("mirrored {}, below {}", mirrored, below));
        }
}

TEST(Textures, NormalMapsTiltTowardsTheirTexturesAxes) {
    const dvec3 tilt = glm::normalize(dvec3(0.5, 0.25, 0.8));
    const Texture texture = plain_texture(glm::vec3(tilt * 0.5 + 0.5));
    for (const bool mirrored : {false, true})
        for (const double angle : {0.0, 40.0, 200.0})
            for (const bool turned : {false, true})    // the other winding
                for (const bool below : {false, true}) // seen from there
                    for (const bool glossy : {false, true})
                        for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark}) {
                            const double c = std::cos(glm::radians(angle)), s = std::sin(glm::radians(angle));
                            Layout layout;
                            layout.linear = glm::dmat2(dvec2(c, s), dvec2(-s, c));
                            if (mirrored)
                                layout.linear = glm::dmat2(dvec2(1, 0), dvec2(0, -1)) * layout.linear;
                            Mesh mesh = laid_out(square(3, scheme), layout);
                            if (turned) {
                                std::reverse(mesh.face_vertices.begin(), mesh.face_vertices.end());
                                mesh.face_texcoords = mesh.face_vertices;
                            }
                            Scene scene = scene_with(mesh, texture);
                            Material& m = scene.materials[0];
                            m.albedo_map.texture = -1;
                            m.normal_map.texture = 0;
                            m.specular = glossy ? 1 : 0;
                            m.normal_scale = 0.5F;
                            const dvec3 from(0.1, below ? -3 : 3, 0.2), to(0.1, 0, 0.07);
                            // Where u and v grow, and the side that faces are counter-clockwise from.
                            const glm::dmat2 back = glm::inverse(layout.linear);
                            const dvec3 u(back[0].x, 0, back[0].y), v(back[1].x, 0, back[1].y);
                            const dvec3 own(0, turned ? -1 : 1, 0);
                            dvec3 expected =
                                glm::normalize(0.5 * tilt.x * u + 0.5 * tilt.y * v + tilt.z * own);
                            if (below != turned)
                                expected = -expected; // the whole surface, as seen from behind
                            expect_near(meet(scene, from, to).normal, expected, 5e-3,
                                        fmt::format("mirrored {}, angle {}, turned {}, below {}, glossy {}",
                                                    mirrored, angle, turned, below, glossy));
                        }
}

TEST(Textures, CoordinatesThatAreNoPlaceGiveFinitePixels) {
    for (const float bad : {1e7F, 1e30F, -3e38F})
        for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark})
            for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
                for (const bool all : {false, true}) {
                    Mesh mesh = laid_out(square(3, scheme), {});
                    for (std::size_t k = 0; k < mesh.texcoords.size(); k += all ? 1 : 5)
                        mesh.texcoords[k].y = bad;
                    Texture texture = random_texture(8, 8, 1);
                    texture.wrap_u = texture.wrap_v = wrap;
                    Scene scene = scene_with(mesh, texture);
                    Material& m = scene.materials[0];
                    m.albedo_map.scale.y = all ? 1e20F : 1;
                    m.normal_map = m.roughness_map = m.metallic_map = m.emission_map = m.albedo_map;
                    m.specular = 1;
                    m.emission = {1, 1, 1};
                    scene.sky = {1, 1, 1};
                    scene.settings.width = scene.settings.height = 8;
                    scene.camera.position = {1, 3, 2};
                    scene.camera.fov_degrees = 10;
                    RenderOptions options;
                    options.threads = 1;
                    const Film film = render_native(scene, options).film;
                    for (const Plane& plane : film.planes)
                        for (const float value : plane.values)
                            ASSERT_TRUE(std::isfinite(value)) << plane.name << ", coordinates of " << bad;
                }
}

TEST(Textures, NeedCoordinates) {
    Mesh mesh = laid_out(square(2, Scheme::bilinear), {});
    mesh.texcoords[3].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(render_native(scene_with(mesh, random_texture(4, 4, 1)), {}), UserError);
    Scene scene = scene_with(square(2, Scheme::bilinear), random_texture(4, 4, 1));
    RenderOptions options;
    options.threads = 1;
    EXPECT_THROW(render_native(scene, options), UserError);
    scene.meshes[0] = laid_out(scene.meshes[0], {});
    EXPECT_NO_THROW(render_native(scene, options));
}

TEST(Textures, OfMaterialsThatNothingHasCostNothing) {
    Scene scene = scene_with(laid_out(square(2, Scheme::bilinear), {}), random_texture(4, 4, 1));
    scene.materials.push_back({"plain"});
    RenderOptions options;
    options.threads = 1;
    const std::string textured = render_native(scene, options).statistics.frame.plan;
    scene.meshes[0].material = 1;
    const std::string unused = render_native(scene, options).statistics.frame.plan;
    scene.materials = {{"plain"}};
    scene.textures.clear();
    scene.meshes[0].material = 0;
    const std::string matte = render_native(scene, options).statistics.frame.plan;
    EXPECT_EQ(unused, matte);
    EXPECT_NE(textured, matte);
}

std::vector<float> picture(const Scene& scene, int threads, int share, std::uint64_t bytes) {
    RenderOptions options;
    options.threads = threads;
    options.share = share;
    options.memory_bytes = bytes;
    std::vector<float> all;
    for (const Plane& plane : render_native(scene, options).film.planes)
        all.insert(all.end(), plane.values.begin(), plane.values.end());
    return all;
}

TEST(Textures, PicturesDoNotDependOnWhoRendersThem) {
    for (const Lod lod : {Lod::recursive, Lod::fixed, Lod::paper, Lod::patch}) {
        Mesh mesh = stretched(urchin_cage());
        Scene scene = scene_of(mesh, 60);
        Mesh& m = scene.meshes[0];
        std::mt19937 random(23);
        for (std::size_t k = 0; k < 2 * m.points.size(); ++k)
            m.texcoords.emplace_back(static_cast<float>(random() % 100) / 30,
                                     static_cast<float>(random() % 100) / 30);
        for (const int point : m.face_vertices)
            m.face_texcoords.push_back(2 * point + static_cast<int>(random() % 2));
        for (std::size_t f = 0; f < m.face_sizes.size(); ++f)
            m.face_materials.push_back(static_cast<int>(f % 2));
        scene.textures = {random_texture(16, 16, 1), random_texture(5, 9, 2)};
        scene.materials.resize(2, scene.materials[0]);
        for (Material& material : scene.materials) {
            material.specular = 1;
            material.roughness_map.texture = material.normal_map.texture = material.albedo_map.texture = 0;
        }
        scene.materials[1].metallic = 1;
        scene.materials[1].albedo_map.texture = 1;
        scene.settings.lod = lod;
        scene.settings.width = scene.settings.height = 48;
        scene.settings.bounces = 2;
        scene.settings.diffuse_bounces = 1;
        const std::vector<float> first = picture(scene, 1, 0, 0);
        for (const int share : {0, 1})
            EXPECT_TRUE(first == picture(scene, 2, share, 0)) << "share " << share;
        std::uint64_t bytes = 32 << 10;
        for (bool done = false; !done; bytes += bytes / 4)
            try {
                EXPECT_TRUE(first == picture(scene, 1, 0, bytes)) << bytes << " bytes";
                done = true;
            } catch (const UserError&) {
            }
        EXPECT_TRUE(first == picture(scene, 2, 1, 2 * bytes)) << bytes << " bytes each";
    }
}

} // namespace
} // namespace razor::test
