// What bounces see has no holes as levels of detail change, and textures neither jump nor have seams; the
// discrete levels do: the checks see it.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/skies.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

Material metal(float roughness) {
    Material m;
    m.name = "metal";
    m.albedo = glm::vec3(1);
    m.metallic = 1;
    m.roughness = roughness;
    return m;
}

/// Seen from within the tube, whose cage's first `sides` points are a ring around it.
Scene inside_tube(const Mesh& mesh, int sides, const Material& material) {
    Scene s = scene_of(mesh, 60);
    dvec3 middle(0);
    for (int k = 0; k < sides; ++k)
        middle += mesh.points[static_cast<std::size_t>(k)] / double(sides);
    s.lights.clear();
    s.materials = {material};
    s.sky = glm::vec3(1);
    s.camera.position = middle;
    s.camera.target = middle + 0.3 * (mesh.points[0] - middle) +
                      0.5 * (mesh.points[static_cast<std::size_t>(sides)] - mesh.points[0]);
    s.camera.fov_degrees = 80;
    s.settings = {.lod = Lod::recursive,
                  .width = 48,
                  .height = 48,
                  .samples = 16,
                  .light_samples = 0,
                  .sky_samples = 0};
    s.settings.bounces = 8;
    return s;
}

/// Of pixels, in all: light that came in through holes, since nothing else has any.
double light_within(const Scene& scene, const std::string& target, std::int64_t& bounces) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    const RenderResult r = render_native(scene, options);
    bounces = r.statistics.frame.by_kind.kind[kind_bounce].rays;
    double sum = 0;
    for (const float value : r.film.find("G")->values)
        sum += double{value};
    return sum;
}

/// Where levels change over a concave place a ray that leaves a surface may begin behind what it sees: one in
/// so many at most of bounces, and of the rays to lights that leave where bounces end.
constexpr double few = 1.0 / 40000, few_to_lights = 1.0 / 4000;

TEST(BounceLevels, HaveNoHoles) {
    for (const Mesh& mesh :
         {torus_cage(9, 6), stretched(torus_cage(9, 6)), bilinear(stretched(torus_cage(9, 6)))})
        for (const float roughness : {0.0F, 0.5F})
            for (const Lod lod : {Lod::recursive, Lod::camera, Lod::fixed}) {
                Scene scene = inside_tube(mesh, 6, metal(roughness));
                scene.settings.lod = lod;
                std::int64_t bounces = 0;
                const double light = light_within(scene, native_targets().back()->name, bounces);
                EXPECT_LE(light * scene.settings.samples,
                          lod == Lod::recursive ? few * static_cast<double>(bounces) : 0)
                    << mesh.name << ' ' << roughness << ' ' << static_cast<int>(lod);
                EXPECT_GT(bounces, 50000) << mesh.name << ' ' << roughness;
            }
}

TEST(BounceLevels, OfDiffuseBouncesHaveNoHoles) {
    Scene scene = inside_tube(stretched(torus_cage(9, 6)), 6, {.name = "white", .albedo = glm::vec3(1)});
    scene.settings.diffuse_bounces = 6;
    std::int64_t bounces = 0;
    // The sky is what shadow rays sample where light goes in all directions: none is left to bounces.
    scene.settings.sky_samples = 1;
    const double light = light_within(scene, native_targets().back()->name, bounces);
    EXPECT_LE(light * scene.settings.samples, few_to_lights * static_cast<double>(bounces));
    EXPECT_GT(bounces, 50000);
}

// Levels that jump at once have holes where one ends.
TEST(BounceLevels, ThatJumpHaveHoles) {
    Scene scene = inside_tube(stretched(torus_cage(9, 6)), 6, metal(0.5F));
    scene.settings.lod = Lod::discrete;
    std::int64_t bounces = 0;
    const double light = light_within(scene, native_targets().back()->name, bounces);
    EXPECT_GT(light * scene.settings.samples, 40 * few * static_cast<double>(bounces));
}

/// Root mean square differences of pictures that follow each other while footprints grow by three octaves,
/// the camera standing still: the largest and the mean one, and by how much one exceeds both beside it. Of
/// those planes.
struct Jumps {
    double largest = 0, mean = 0, spike = 0;
};
Jumps zoom(Scene s, Lod lod, const std::vector<const char*>& planes) {
    constexpr int frames = 72;
    s.settings.lod = lod;
    std::vector<float> before;
    std::vector<double> differences;
    Jumps jumps;
    for (int f = 0; f <= frames; ++f) {
        s.settings.edge_pixels = 2 * std::exp2(3.0 * f / frames);
        RenderOptions options;
        options.threads = 2;
        const Film film = render_native(s, options).film;
        std::vector<float> now;
        for (const char* const plane : planes) {
            const std::vector<float>& values = film.find(plane)->values;
            now.insert(now.end(), values.begin(), values.end());
        }
        double square = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
            square += std::pow(double{now[i]} - before[i], 2);
        const double difference = std::sqrt(square / static_cast<double>(now.size()));
        jumps.largest = std::max(jumps.largest, difference);
        jumps.mean += difference / frames;
        if (f > 0)
            differences.push_back(difference);
        before = now;
    }
    for (std::size_t i = 1; i + 1 < differences.size(); ++i)
        jumps.spike =
            std::max(jumps.spike, differences[i] - std::max(differences[i - 1], differences[i + 1]));
    return jumps;
}

/// Rings and sides are the texture coordinates, with a seam along each.
Mesh textured_torus(int rings, int sides) {
    Mesh m = torus_cage(rings, sides);
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sides; ++j)
            m.texcoords.emplace_back(static_cast<float>(i) / static_cast<float>(rings),
                                     static_cast<float>(j) / static_cast<float>(sides));
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                m.face_texcoords.push_back((i + di) * (sides + 1) + j + dj);
    return m;
}

Scene textured_scene() {
    Scene s = scene_of(textured_torus(9, 6), 160);
    s.textures = {sky_texture(64, 64, [](double u, double v) {
        return glm::vec3(0.5 + 0.45 * std::cos(2 * pi * u), 0.5 + 0.45 * std::cos(4 * pi * v), 0.5);
    })};
    s.materials[0].albedo = glm::vec3(1);
    s.materials[0].albedo_map.texture = 0;
    s.lights.clear();
    s.sky = glm::vec3(0);
    s.settings = {
        .lod = Lod::recursive, .width = 64, .height = 64, .samples = 4, .light_samples = 0, .sky_samples = 0};
    return s;
}

void expect_fewer_jumps(const char* what, const Scene& scene, const std::vector<const char*>& planes) {
    const Jumps recursive = zoom(scene, Lod::recursive, planes),
                discrete = zoom(scene, Lod::discrete, planes);
    fmt::print("  {}: largest and mean difference {:.5f} {:.5f}, of discrete levels {:.5f} {:.5f}\n", what,
               recursive.largest, recursive.mean, discrete.largest, discrete.mean);
    EXPECT_GT(discrete.largest, 0) << what;
    EXPECT_LT(recursive.largest, 0.7 * discrete.largest) << what;
}

TEST(TextureLevels, DoNotJump) {
    expect_fewer_jumps("a textured torus", textured_scene(), {"albedo.R", "albedo.G"});
}

/// In a convex shell that shines by a picture, without a jump anywhere, before a board or a blob of that
/// material, of which the camera sees nothing but the middle.
Scene within_shell(const Material& of, bool blob) {
    Scene s;
    Mesh shell = cube_cage();
    for (dvec3& p : shell.points)
        p *= 10.0;
    shell.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t f = 0; f < shell.face_sizes.size(); ++f)
        shell.face_texcoords.insert(shell.face_texcoords.end(), {0, 1, 2, 3});
    shell.edge_length = 0.1;
    Mesh before;
    if (blob) {
        before = cube_cage();
        for (dvec3& p : before.points)
            p = 1.5 * p - dvec3(0, 0, 3);
    } else {
        before.points = {{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}};
        before.face_sizes = {4};
        before.face_vertices = {0, 1, 2, 3};
        before.scheme = Scheme::bilinear;
    }
    before.name = "before";
    before.edge_length = 0.02;
    before.material = 1;
    s.meshes = {shell, before};
    Material shining{.name = "shining", .albedo = glm::vec3(0), .emission = glm::vec3(1)};
    shining.emission_map.texture = 0;
    s.textures = {sky_texture(64, 64, [](double u, double v) {
        const auto hills = [&](double n) { return std::pow(std::sin(n * pi * u) * std::sin(n * pi * v), 2); };
        return glm::vec3(0.05 + 0.9 * hills(1), 0.05 + 0.9 * hills(4), 0.5);
    })};
    s.materials = {shining, of};
    s.lights.clear();
    s.sky = glm::vec3(0);
    s.camera.position = {0.3, 0.2, 1};
    s.camera.target = {0.1, 0, -2};
    s.camera.fov_degrees = 25;
    s.settings = {
        .lod = Lod::recursive, .width = 32, .height = 32, .samples = 4, .light_samples = 0, .sky_samples = 0};
    s.settings.bounces = 4;
    return s;
}

TEST(BounceLevels, DoNotJump) {
    Material glass{.name = "glass"};
    glass.specular = 1;
    glass.transmission = 1;
    glass.roughness = 0;
    // A blob's coarsest levels are far apart: rays leave it as far off as their vertices move, which is not
    // always four times as far a level.
    for (const auto& [name, material, blob, bound] : {std::tuple{"mirror", metal(0), false, 0.001},
                                                      {"blob of metal", metal(0), true, 0.012},
                                                      {"rough metal", metal(0.5F), false, 0.001},
                                                      {"rough blob", metal(0.5F), true, 0.006},
                                                      {"glass", glass, false, 0.0005},
                                                      {"matte", Material{.name = "matte"}, false, 0.0005}}) {
        Scene s = within_shell(material, blob);
        if (is_matte(material))
            s.settings.diffuse_bounces = 1;
        const Jumps jumps = zoom(s, Lod::recursive, {"R", "G"});
        fmt::print("  {}: largest and mean difference {:.5f} {:.5f}, alone {:.5f}\n", name, jumps.largest,
                   jumps.mean, jumps.spike);
        EXPECT_GT(jumps.mean, 1e-5) << name;
        EXPECT_LT(jumps.spike, bound) << name;
    }
}

// A texture that goes on where it ends has no seam where the faces' coordinates have one, nor at edges of
// patches, whatever levels meet there: neighbouring pixels of one piece of surface differ by no more than the
// texture's slope allows.
TEST(TextureLevels, HaveNoSeams) {
    Scene scene = textured_scene();
    scene.settings.width = scene.settings.height = 160;
    scene.settings.samples = 16;
    for (const double edge_pixels : {1.0, 6.0})
        for (const KernelTable* target : best_target()) {
            scene.settings.edge_pixels = edge_pixels;
            RenderOptions options;
            options.threads = 2;
            options.isa = target->name;
            const Film film = render_native(scene, options).film;
            const std::vector<float>&depth = film.find("depth.Z")->values,
                  &nx = film.find("normal.X")->values, &ny = film.find("normal.Y")->values,
                  &nz = film.find("normal.Z")->values;
            // What a pixel shows of the surface grows as it is seen edge-on.
            const dvec3 toward = glm::normalize(scene.camera.position - scene.camera.target);
            double worst = 0;
            int pairs = 0;
            for (const char* const plane : {"albedo.R", "albedo.G"}) {
                const std::vector<float>& albedo = film.find(plane)->values;
                for (std::size_t i = 0; i + 161 < albedo.size(); ++i)
                    for (const std::size_t next : {i + 1, i + 160}) {
                        const auto facing = [&](std::size_t p) {
                            return glm::dot(dvec3(nx[p], ny[p], nz[p]), toward);
                        };
                        const double cosine = std::min(facing(i), facing(next));
                        if (!std::isfinite(depth[i] + depth[next]) || cosine < 0.5 ||
                            std::abs(depth[i] - depth[next]) > 0.1F)
                            continue;
                        ++pairs;
                        worst = std::max(worst, std::abs(double{albedo[i]} - albedo[next]) * cosine);
                    }
            }
            EXPECT_GT(pairs, 5000);
            EXPECT_LT(worst, 0.2) << target->name << ", " << edge_pixels;
        }
}

} // namespace
} // namespace razor::test
