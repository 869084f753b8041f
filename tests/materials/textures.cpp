// Textures on floors: the albedo, and the normal, that one ray sees against lookups in double by what
// razor/scene/texture.h and material.h say, whatever the floor is made of.
#include "razor/scene/error.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/texture_lookup.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor::test {
namespace {

using glm::dvec2;
using glm::dvec3;

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
        expect_near(met.albedo, colour_at(texture, mapped_by(map, layout(target)), area),
                    1e-4 + 5e-5 / toward.y, fmt::format("place {}, level {}", n, level));
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
        expect_near(met.albedo, colour_at(texture, layout(met.position), 0), 3e-3,
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
