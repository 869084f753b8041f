// What textures make of surfaces, found at vertices of grids: against the same found at hits, in less
// evaluations, whoever renders.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/skies.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

namespace razor::test {
namespace {

using std::numbers::pi;

/// A torus all of whose maps are waves, one seam along each coordinate.
Scene all_maps(int width) {
    const int rings = 9, sides = 6;
    Mesh m = torus_cage(rings, sides);
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sides; ++j)
            m.texcoords.emplace_back(static_cast<float>(i) / rings, static_cast<float>(j) / sides);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                m.face_texcoords.push_back((i + di) * (sides + 1) + j + dj);
    Scene s = scene_of(m, width);
    s.textures = {sky_texture(64, 64,
                              [](double u, double v) {
                                  return glm::vec3(0.5 + 0.45 * std::cos(2 * pi * u),
                                                   0.5 + 0.45 * std::cos(4 * pi * v), 0.5);
                              }),
                  sky_texture(64, 64, [](double u, double v) {
                      return glm::vec3(0.5 + 0.1 * std::cos(6 * pi * u), 0.5 + 0.1 * std::sin(4 * pi * v),
                                       0.98);
                  })};
    Material& a = s.materials[0];
    a.albedo = a.emission = glm::vec3(1);
    a.specular = a.metallic = a.roughness = 1;
    a.albedo_map.texture = a.metallic_map.texture = a.roughness_map.texture = a.emission_map.texture = 0;
    a.normal_map.texture = 1;
    a.bump_map = {.texture = 0, .scale = {4, 4}};
    a.bump = 0.02F;
    s.lights.clear();
    s.sky = glm::vec3(0.3F);
    s.settings = {.width = width, .height = width, .samples = 16, .light_samples = 0, .sky_samples = 1};
    return s;
}

RenderResult rendered(const Scene& scene, RenderOptions options = {}) {
    if (options.threads == 0)
        options.threads = 2;
    return render_native(scene, options);
}

/// Root mean square, over planes whose name begins so.
double difference(const Film& a, const Film& b, const std::string& prefix) {
    double sum = 0;
    std::size_t count = 0;
    for (const Plane& plane : a.planes)
        if (plane.name.starts_with(prefix)) {
            const std::vector<float>& other = b.find(plane.name)->values;
            for (std::size_t p = 0; p < other.size(); ++p)
                sum += std::pow(double{plane.values[p]} - double{other[p]}, 2);
            count += other.size();
        }
    EXPECT_GT(count, 0U) << prefix;
    return std::sqrt(sum / static_cast<double>(count));
}

// Between vertices values are linear: the closer these are, the less that matters, by the square.
TEST(PhaseOne, ComesToWhatHitsFind) {
    double before = 1;
    for (const double edge_pixels : {4.0, 2.0, 1.0}) {
        Scene scene = all_maps(96);
        scene.settings.edge_pixels = edge_pixels;
        const RenderResult grids = rendered(scene);
        scene.settings.shading = Shading::hits;
        const RenderResult hits = rendered(scene);
        EXPECT_GT(grids.statistics.frame.counters.grid_evaluations, 0);
        EXPECT_EQ(hits.statistics.frame.counters.grid_evaluations, 0);
        const double albedo = difference(grids.film, hits.film, "albedo"),
                     normal = difference(grids.film, hits.film, "normal");
        fmt::print("  edges of {} pixels: albedo differs by {:.5f}, normals by {:.5f}\n", edge_pixels, albedo,
                   normal);
        EXPECT_GT(albedo, 0);
        EXPECT_LT(albedo, 0.6 * before);
        EXPECT_LT(normal, 0.02);
        before = albedo;
    }
    EXPECT_LT(before, 0.003);
}

// Each vertex is shaded once, whatever many samples see it, and only where a camera ray is.
TEST(PhaseOne, TakesAThirdOfTheEvaluations) {
    const Scene scene = all_maps(160);
    const Counters c = rendered(scene).statistics.frame.counters;
    EXPECT_GT(c.textured_hits, 30000);
    EXPECT_EQ(c.textured_hits, c.camera_hits + c.bounce_hits);
    Scene matte = scene;
    matte.settings.bounces = 0;
    const Counters m = rendered(matte).statistics.frame.counters;
    EXPECT_EQ(m.textured_hits, m.camera_hits);
    EXPECT_EQ(m.shading_evaluations, m.grid_evaluations);
    EXPECT_LE(3 * m.shading_evaluations, m.textured_hits);
    EXPECT_LE(m.grid_evaluations, m.vertices_made);
    EXPECT_GE(10 * m.grid_evaluations, 7 * m.grid_lanes);
}

// Blocks that are as fine as their mesh gets, but coarser than what rays ask for, are found at hits.
TEST(PhaseOne, LeavesToHitsWhatGridsCannotShow) {
    Scene scene = all_maps(96);
    scene.meshes[0].edge_length = 0.5;
    scene.settings.bounces = 0;
    const RenderResult grids = rendered(scene);
    EXPECT_GT(grids.statistics.frame.counters.shading_evaluations,
              grids.statistics.frame.counters.grid_evaluations);
    scene.settings.shading = Shading::hits;
    const RenderResult hits = rendered(scene);
    EXPECT_LT(difference(grids.film, hits.film, "albedo"), 0.002);
}

TEST(PhaseOne, DoesNotDependOnWhoRenders) {
    const Scene scene = all_maps(64);
    RenderOptions alone;
    alone.threads = 1;
    const Film reference = rendered(scene, alone).film;
    const auto expect_same = [&](const RenderOptions& options, const std::string& what) {
        const Film film = rendered(scene, options).film;
        for (const Plane& plane : reference.planes)
            EXPECT_EQ(std::memcmp(plane.values.data(), film.find(plane.name)->values.data(),
                                  plane.values.size() * sizeof(float)),
                      0)
                << what << ' ' << plane.name;
    };
    for (const int share : {0, 1, 2}) {
        RenderOptions options;
        options.threads = 3;
        options.share = share;
        expect_same(options, fmt::format("{} workers a tree", share));
    }
    RenderOptions budget;
    budget.threads = 2;
    budget.memory_bytes = std::uint64_t{3} << 20;
    expect_same(budget, "a memory budget");
}

// Levels of every kind show the same texture.
TEST(PhaseOne, IsOfEveryKindOfLevels) {
    for (const Lod lod : {Lod::recursive, Lod::paper, Lod::discrete, Lod::patch, Lod::camera, Lod::fixed}) {
        Scene scene = all_maps(96);
        scene.settings.lod = lod;
        const RenderResult grids = rendered(scene);
        scene.settings.shading = Shading::hits;
        const RenderResult hits = rendered(scene);
        EXPECT_GT(grids.statistics.frame.counters.grid_evaluations, 0) << static_cast<int>(lod);
        EXPECT_LT(difference(grids.film, hits.film, "albedo"), 0.006) << static_cast<int>(lod);
    }
}

} // namespace
} // namespace razor::test
