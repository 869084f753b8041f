// What displacement makes of pictures: nothing where there is none, closed forms where there are some, the
// same whoever renders them.
#include "razor/native/render.h"
#include "tests/displacement/heights.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

std::vector<float> picture(const Scene& scene, const std::string& isa, int threads = 1, int share = 0,
                           std::uint64_t bytes = 0) {
    RenderOptions options;
    options.threads = threads;
    options.share = share;
    options.memory_bytes = bytes;
    options.isa = isa;
    std::vector<float> all;
    for (const Plane& plane : render_native(scene, options).film.planes)
        all.insert(all.end(), plane.values.begin(), plane.values.end());
    return all;
}

TEST(DisplacedPictures, WithoutHeightsAreThoseOfTheSurface) {
    for (const bool straight : {false, true}) {
        Mesh mesh = with_seams(urchin_cage());
        if (straight)
            mesh = bilinear(mesh);
        Scene scene = displaced_scene(mesh, 60, smooth_heights(), 0, 0.5);
        const std::string isa = native_targets().back()->name;
        const std::vector<float> nothing = picture(scene, isa);
        Scene level = displaced_scene(mesh, 60, constant_heights(0.5F), 1, 0.5);
        EXPECT_TRUE(picture(level, isa) == nothing);
        scene.materials[0].displacement_map.texture = -1;
        EXPECT_TRUE(picture(scene, isa) == nothing);
        scene.materials[0].displacement_map.texture = 0;
        scene.materials[0].displacement_scale = 0.05F;
        EXPECT_FALSE(picture(scene, isa) == nothing);
    }
}

/// A floor of n x n quads, seen from above by parallel rays.
Scene floor(int n, Scheme scheme, const Texture& texture, double scale, double midlevel) {
    Mesh m;
    m.name = "floor";
    m.scheme = scheme;
    m.boundary = BoundaryInterpolation::edge_and_corner;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            m.points.emplace_back(2.0 * i / n - 1, 0, 1 - 2.0 * j / n);
            m.texcoords.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int p = j * (n + 1) + i;
            m.face_sizes.push_back(4);
            m.face_vertices.insert(m.face_vertices.end(), {p, p + 1, p + n + 2, p + n + 1});
        }
    m.face_texcoords = m.face_vertices;
    m.face_varying = FaceVaryingInterpolation::all;
    Scene s = displaced_scene(m, 1000, texture, scale, midlevel);
    s.meshes[0].edge_length = 1.0 / 32;
    s.camera.projection = Projection::orthographic;
    s.camera.position = {0, 3, 0};
    s.camera.target = {0, 0, 0};
    s.camera.up = {0, 0, -1};
    s.camera.height = 1.6;
    s.settings.width = s.settings.height = 16;
    s.settings.samples = 1;
    s.settings.lod = Lod::object;
    return s;
}

/// A ramp over all of u: texel x of 64 is x / 64, so that height is u - 1/128.
Texture ramp() {
    Texture t = height_texture(64, 2, [](int x, int) { return static_cast<float>(x) / 64; });
    t.wrap_u = Wrap::clamp;
    return t;
}

Film film_of(const Scene& scene) {
    RenderOptions options;
    options.threads = 1;
    return render_native(scene, options).film;
}

TEST(DisplacedPictures, OfLevelAndSlopingFloorsAreKnown) {
    for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark})
        for (const int n : {1, 3}) {
            const Film level = film_of(floor(n, scheme, constant_heights(0.75F), 0.4, 0.25));
            const Film slope = film_of(floor(n, scheme, ramp(), 0.5, 0.25));
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.25, 1, 0)); // half as long as wide
            for (std::size_t p = 0; p < 256; ++p) {
                EXPECT_NEAR(level.find("depth.Z")->values[p], 3 - 0.2, 1e-5);
                EXPECT_NEAR(level.find("normal.Y")->values[p], 1, 1e-5);
                const double x = 1.6 * ((static_cast<double>(p % 16) + 0.5) / 16 - 0.5);
                const double u = (x + 1) / 2;
                // Pixels are sampled somewhere inside.
                EXPECT_NEAR(slope.find("depth.Z")->values[p], 3 - 0.5 * (u - 1.0 / 128 - 0.25), 0.025 + 1e-4);
                EXPECT_NEAR(slope.find("normal.X")->values[p], normal.x, 1e-3);
                EXPECT_NEAR(slope.find("normal.Y")->values[p], normal.y, 1e-3);
            }
        }
}

TEST(DisplacedPictures, ScaleWithInstances) {
    Scene one = floor(3, Scheme::catmull_clark, smooth_heights(), 0.3, 0.2);
    Scene half = one;
    half.graph.groups = {{"scene", {{.name = "floor", .mesh = 0, .local = {.scale = glm::dvec3(0.5)}}}}};
    half.camera.height = 0.8;
    half.camera.position = {0, 1.5, 0};
    one.settings.lod = half.settings.lod = Lod::fixed;
    one.meshes[0].edge_length = 1.0 / 32;
    half.meshes[0].edge_length = 1.0 / 64; // in the world
    const Film a = film_of(one), b = film_of(half);
    for (std::size_t p = 0; p < 256; ++p)
        EXPECT_NEAR(a.find("depth.Z")->values[p], 2 * b.find("depth.Z")->values[p], 1e-5);
}

Scene rich_scene() {
    Scene scene = displaced_scene(with_seams(stretched(urchin_cage())), 60, smooth_heights(), 0.05, 0.5);
    scene.settings.width = scene.settings.height = 40;
    scene.materials[0].specular = 1;
    scene.settings.bounces = 2;
    return scene;
}

TEST(DisplacedPictures, DoNotDependOnWhoRendersThem) {
    const Scene scene = rich_scene();
    const std::string isa = native_targets().back()->name;
    const std::vector<float> first = picture(scene, isa);
    for (const int share : {0, 1})
        EXPECT_TRUE(first == picture(scene, isa, 2, share)) << "share " << share;
    EXPECT_TRUE(first == picture(scene, isa, 1, 0, 8 << 20));
    for (const KernelTable* target : native_targets())
        if (target->name == std::string("avx2") || target->name == std::string("avx512")) {
            EXPECT_TRUE(first == picture(scene, target->name)) << target->name;
        }
}

TEST(DisplacedPictures, AreFiniteWithHeightsOfAnySize) {
    for (const double scale : {1e-30, 1e-6, 1e3, -1e3, 1e9}) {
        Scene scene = rich_scene();
        scene.materials[0].displacement_scale = static_cast<float>(scale);
        for (const float value : picture(scene, native_targets().back()->name))
            ASSERT_FALSE(std::isnan(value)) << scale;
    }
}

} // namespace
} // namespace razor::test
