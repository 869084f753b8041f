// Whole pictures of small rooms against paths that are followed one by one in double.
#include "tests/displacement/heights.h"
#include "tests/materials/compare_paths.h"
#include "tests/materials/room.h"
#include "tests/materials/skies.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

using glm::dvec3;

/// Each mesh mirrored, and drawn mirrored again.
Scene twice_mirrored(Scene s) {
    s.graph.groups = {{"scene", {}}};
    for (std::size_t m = 0; m < s.meshes.size(); ++m) {
        Mesh& mesh = s.meshes[m];
        for (dvec3& p : mesh.points)
            p.x = -p.x;
        std::reverse(mesh.face_vertices.begin(), mesh.face_vertices.end());
        std::reverse(mesh.face_sizes.begin(), mesh.face_sizes.end());
        Transform mirror{.scale = {-1, 1, 1}};
        s.graph.groups[0].placements.push_back(
            {.name = mesh.name, .mesh = static_cast<int>(m), .local = mirror});
    }
    return s;
}

TEST(Paths, DiffuseBouncesAndEmission) {
    for (const int diffuse_bounces : {0, 1, 2})
        for (const bool light : {false, true}) {
            Scene s = room();
            s.name =
                fmt::format("box and lamp{}, {} diffuse bounces", light ? ", a light" : "", diffuse_bounces);
            s.meshes.push_back(box("box", {-1.1, 0, -0.6}, {1, 1.2, 0.9}, 25, 0));
            s.meshes.push_back(quad("lamp", {0.6, 0.2, -1.4}, {0.9, 0, 0.1}, {0, 0.8, 0.1}, 3));
            s.materials.push_back(named("lamp", {0.2F, 0.2F, 0.2F}));
            s.materials.back().emission = {2, 1, 0.5F};
            s.materials.back().light = light;
            s.settings.diffuse_bounces = diffuse_bounces;
            const PlainPicture want = expect_same_picture(s, 160);
            Scene other = s;
            other.settings.diffuse_bounces = (diffuse_bounces + 1) % 3;
            expect_other_picture(want, other);
        }
}

TEST(Paths, MirrorAndRoughMetal) {
    for (const float roughness : {0.35F, 0.7F}) {
        Scene s = room();
        s.name = fmt::format("mirror and metal of roughness {}", roughness);
        s.meshes[1].material = 3;
        s.meshes.push_back(ball("ball", {-0.4, 0.8, 0}, 0.8, 4));
        s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = 0;
        s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = roughness;
        s.settings.diffuse_bounces = 1;
        const PlainPicture want = expect_same_picture(s, 160);
        for (const std::size_t m : {3U, 4U}) {
            Scene plastic = s;
            plastic.materials[m].metallic = 0;
            expect_other_picture(want, plastic);
        }
    }
}

// What lobes find of surfaces that are lights, and rays to these, is never counted twice.
TEST(Paths, MirrorsAndLampsOfTriangles) {
    for (const float roughness : {0.2F, 0.6F}) {
        Scene s = room();
        s.name = fmt::format("metal of roughness {} and lamps", roughness);
        s.lights.clear();
        s.meshes[1].material = 3;
        s.meshes.push_back(box("box", {-1.1, 0, -0.6}, {1, 1.2, 0.9}, 25, 4));
        s.meshes.push_back(ball("lamp", {0.5, 2, 0.3}, 0.4, 5));
        s.meshes.push_back(quad("panel", {0.6, 0.2, -1.4}, {0.9, 0, 0.1}, {0, 0.8, 0.1}, 6));
        s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = 0;
        s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = roughness;
        s.materials[0].specular = 1;
        s.materials[0].roughness = roughness;
        s.materials.push_back(named("lamp", {0.2F, 0.2F, 0.2F}));
        s.materials.back().emission = {8, 7, 5};
        s.materials.back().light = true;
        s.materials.push_back(named("panel", {0.5F, 0.1F, 0.1F}));
        s.materials.back().emission = {0.5F, 2, 1};
        s.materials.back().light = true;
        s.settings.diffuse_bounces = 1;
        expect_same_picture(s, 160);
    }
}

TEST(Paths, UnderAMappedSky) {
    Scene s = room();
    s.name = "metal and plastic under a mapped sky";
    s.sky = {1, 0.9F, 0.8F};
    set_sky(s, sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.4, 3); }), 200);
    s.lights.clear();
    s.materials[0].specular = 1;
    s.materials[0].roughness = 0.4F;
    s.meshes[1].material = 3;
    s.meshes.push_back(ball("ball", {-0.4, 0.8, 0}, 0.8, 4));
    s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0;
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.5F;
    s.settings.diffuse_bounces = 1;
    expect_same_picture(s, 320);
}

TEST(Paths, PlasticAndCoats) {
    for (const bool rough_coat : {false, true}) {
        Scene s = room();
        s.name = rough_coat ? "plastic under a rough coat" : "plastic, smooth coat";
        s.materials[0].specular = 1;
        s.materials[0].roughness = 0.4F;
        s.meshes.push_back(box("box", {-0.9, 0, -0.6}, {1, 1.2, 0.9}, 25, 3));
        s.materials.push_back(named("coated", {0.2F, 0.5F, 0.2F}));
        Material& m = s.materials.back();
        m.coat = 1;
        m.coat_roughness = rough_coat ? 0.3F : 0;
        m.specular = rough_coat ? 1 : 0;
        m.roughness = 0.6F;
        s.settings.diffuse_bounces = 2;
        const PlainPicture want = expect_same_picture(s, 160);
        Scene bare = s, matte = s;
        bare.materials[3].coat = 0;
        matte.materials[0].specular = 0;
        expect_other_picture(want, bare);
        expect_other_picture(want, matte);
    }
}

TEST(Paths, Sheen) {
    for (const float roughness : {0.3F, 0.8F}) {
        Scene s = room();
        s.name = fmt::format("sheen of roughness {}, over plastic and metal", roughness);
        s.meshes.push_back(box("box", {-0.9, 0, -0.6}, {1, 1.2, 0.9}, 25, 3));
        s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
        s.materials.back().metallic = 1;
        s.materials.back().roughness = 0.5F;
        s.materials.back().sheen = {0.3F, 0.6F, 0.9F};
        s.materials.back().sheen_roughness = 1 - roughness;
        s.materials[0].specular = 1;
        s.materials[0].sheen = {1, 0.8F, 0.6F};
        s.materials[0].sheen_roughness = roughness;
        s.materials[1].albedo = {0, 0, 0};
        s.materials[1].sheen = {0.4F, 1, 0.2F};
        s.materials[1].sheen_roughness = roughness;
        s.settings.diffuse_bounces = 2;
        const PlainPicture want = expect_same_picture(s, 160);
        Scene without = s;
        without.materials[1].sheen = {0, 0, 0};
        expect_other_picture(want, without);
    }
}

Texture pattern_texture(PatternKind kind, double size, float amount, const glm::vec3& low,
                        const glm::vec3& high) {
    Texture t;
    t.name = "pattern";
    t.pattern = Pattern{.kind = kind, .size = size, .low = low, .high = high, .octaves = 3};
    t.pattern->amount = amount;
    return t;
}

// The floor's roughness by opacity of a picture, its colour by the same picture; the box's by patterns.
TEST(Paths, SheenMaps) {
    Scene s = room();
    s.name = "maps of sheen";
    const auto wave = [](double x) { return 0.5 + 0.5 * std::sin(6.2831853 * x); };
    s.textures = {rgba_texture(64, 64,
                               [&](double u, double v) {
                                   return glm::vec4(wave(u), 0.9, wave(v), 0.25 + 0.7 * wave(u + v));
                               }),
                  pattern_texture(PatternKind::checker, 0.7, 0, {0.2F, 0.25F, 0.1F}, {0.9F, 0.9F, 1}),
                  pattern_texture(PatternKind::noise, 0.9, 0, {0.1F, 0.3F, 0.1F}, {1, 0.8F, 0.9F})};
    s.meshes[0].texcoords = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    s.meshes[0].face_texcoords = {0, 1, 2, 3};
    s.materials[0].albedo = {0.1F, 0.1F, 0.1F};
    s.materials[0].sheen = {1, 0.9F, 0.8F};
    s.materials[0].sheen_roughness = 0.9F;
    s.materials[0].sheen_map.texture = s.materials[0].sheen_roughness_map.texture = 0;
    s.meshes.push_back(box("box", {-1.2, 0, -0.6}, {1.4, 1.6, 1.2}, 25, 3));
    s.materials.push_back(named("metal", {0.3F, 0.2F, 0.1F}));
    s.materials[3].metallic = 1;
    s.materials[3].roughness = 0.5F;
    s.materials[3].sheen = {1, 1, 1};
    s.materials[3].sheen_roughness = 1;
    s.materials[3].sheen_map.texture = 2;
    s.materials[3].sheen_roughness_map.texture = 1;
    s.camera.position = {1.6, 1.1, 5}; // sheen is of grazing angles
    s.settings.diffuse_bounces = 1;
    s.settings.edge_pixels = 0.25;
    const PlainPicture want = expect_same_picture(s, 80);
    for (const std::size_t m : {0U, 3U})
        for (TextureMap Material::*const map : {&Material::sheen_map, &Material::sheen_roughness_map}) {
            Scene without = s;
            (without.materials[m].*map).texture = -1;
            fmt::print("    material {}, {}:", m, map == &Material::sheen_map ? "colour" : "roughness");
            expect_other_picture(want, without);
        }
}

TEST(Paths, GlassBox) {
    for (const int bounces : {3, 6}) {
        Scene s = room();
        s.name = fmt::format("glass, {} bounces", bounces);
        s.meshes.push_back(box("glass", {-0.9, 0.1, -0.2}, {1.2, 1.3, 0.8}, 30, 3));
        s.materials.push_back(named("glass", {0.9F, 1, 0.9F}));
        Material& m = s.materials.back();
        m.specular = 1;
        m.roughness = 0;
        m.transmission = 1;
        m.ior = 1.4F;
        s.settings.bounces = bounces;
        s.settings.diffuse_bounces = 1;
        expect_same_picture(s, 160);
        if (bounces == 6) { // outside and inside are where they were
            s.name += ", mirrored twice";
            const Scene mirrored = twice_mirrored(s);
            const PlainPicture want = expect_same_picture(s, 160, &mirrored);
            Scene opaque = s, thin = s;
            opaque.materials[3].transmission = 0;
            thin.materials[3].ior = 1.1F;
            expect_other_picture(want, opaque);
            expect_other_picture(want, thin);
        }
    }
}

// Filters as narrow as rays allow: what they are of is compared elsewhere.
TEST(Paths, Patterns) {
    const std::pair<PatternKind, PatternKind> pairs[] = {{PatternKind::checker, PatternKind::noise},
                                                         {PatternKind::bricks, PatternKind::turbulence},
                                                         {PatternKind::wood, PatternKind::marble}};
    for (const auto& [of_floor, of_box] : pairs) {
        Scene s = room();
        s.name = fmt::format("patterns {} and {}", static_cast<int>(of_floor), static_cast<int>(of_box));
        s.textures = {pattern_texture(of_floor, 1.7, 0.15F, {0.1F, 0.2F, 0.6F}, {0.9F, 0.7F, 0.3F}),
                      pattern_texture(of_box, 1.1, 0.8F, {0.2F, 0.4F, 0.9F}, {1, 1, 0.5F})};
        s.meshes.push_back(box("box", {-1.4, 0, -0.6}, {1.6, 1.8, 1.2}, 25, 3));
        s.materials[0].albedo = {1, 1, 1};
        s.materials[0].albedo_map.texture = 0;
        s.materials.push_back(named("box", {0.9F, 0.8F, 0.7F})); // a metal whose roughness and colour vary
        s.materials[3].metallic = 1;
        s.materials[3].roughness = 0.8F;
        s.materials[3].albedo_map.texture = s.materials[3].roughness_map.texture = 1;
        s.settings.diffuse_bounces = 1;
        s.settings.edge_pixels = 0.1;
        const PlainPicture want = expect_same_picture(s, 160);
        for (const std::size_t t : {0U, 1U}) {
            Scene other = s;
            other.textures[t].pattern->size *= 1.6;
            expect_other_picture(want, other);
        }
    }
}

TEST(Paths, Bumps) {
    for (const bool plastic : {false, true}) {
        Scene s = room();
        s.name = plastic ? "bumps of plastic" : "bumps";
        s.textures = {pattern_texture(PatternKind::marble, 2, 0.2F, {0, 0, 0}, {1, 1, 1}),
                      pattern_texture(PatternKind::noise, 1.2, 0, {1, 0, 0}, {0, 1, 0})};
        s.meshes.push_back(box("box", {-1.4, 0, -0.6}, {1.6, 1.8, 1.2}, 25, 3));
        s.materials.push_back(named("box", {0.6F, 0.7F, 0.5F}));
        s.materials[0].bump_map.texture = 0;
        s.materials[0].bump = 0.35F;
        s.materials[3].bump_map.texture = 1;
        s.materials[3].bump = 1.2F;
        for (const std::size_t m : {0U, 3U}) {
            s.materials[m].specular = plastic ? 1.0F : 0.0F;
            s.materials[m].roughness = 0.5F;
        }
        s.settings.diffuse_bounces = 1;
        s.settings.edge_pixels = 0.1;
        const PlainPicture want = expect_same_picture(s, 320);
        for (const std::size_t m : {0U, 3U}) {
            Scene other = s;
            other.materials[m].bump = 0;
            expect_other_picture(want, other);
        }
    }
}

TEST(Paths, Displacement) {
    for (const bool metal : {false, true}) {
        Scene s = room();
        s.name = metal ? "metal displaced by noise" : "displaced";
        s.textures = {height_texture(96, 96, [](int x, int y) {
            const auto wave = [](int k) { return std::sin(0.065449847F * (static_cast<float>(k) + 0.5F)); };
            return 0.5F + 0.3F * wave(x) * wave(y) + 0.2F * wave(x + y);
        })};
        if (metal)
            s.textures = {pattern_heights(PatternKind::noise)};
        Mesh panel = quad("panel", {-1.6, 0.2, 0.2}, {2.6, 0, 0.6}, {-0.2, 1.7, -1.2}, 3);
        panel.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        panel.face_texcoords = {0, 1, 2, 3};
        panel.edge_length = 1.0 / 64;
        s.meshes.push_back(panel);
        s.materials.push_back(named("panel", {0.8F, 0.6F, 0.4F}));
        Material& m = s.materials.back();
        m.displacement_map.texture = 0;
        m.displacement_scale = 0.4F;
        m.metallic = metal ? 1.0F : 0.0F;
        m.roughness = 0.5F;
        s.settings.diffuse_bounces = 1;
        s.settings.edge_pixels = 0.1;
        const PlainPicture want = expect_same_picture(s, 160);
        Scene other = s;
        other.materials[3].displacement_scale = 0;
        expect_other_picture(want, other);
    }
}

// Backs that are seen, that shine, that are lit and that mirrors see are not there.
TEST(Paths, SurfacesOfOneSide) {
    Scene s = room();
    s.name = "surfaces of one side";
    s.meshes.push_back(quad("away", {-1, 0, 0.2}, {0, 1.4, 0}, {1.2, 0, 0.3}, 3)); // its back to the camera
    s.meshes.push_back(quad("toward", {0.4, 0, 0.4}, {0.9, 0, 0.2}, {0, 1.1, -0.2}, 3));
    s.meshes.push_back(quad("lamp", {-1.8, 0.6, 0.4}, {0, 0.9, 0}, {0.7, 0, -0.8}, 4));
    s.meshes[1].material = 5;
    s.materials.push_back(named("board", {0.8F, 0.4F, 0.2F}));
    s.materials.push_back(named("lamp", {0.2F, 0.2F, 0.2F}));
    s.materials[4].emission = {5, 4, 2};
    s.materials[4].light = true;
    s.materials[3].two_sided = s.materials[4].two_sided = false;
    s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
    s.materials[5].metallic = 1;
    s.materials[5].roughness = 0;
    s.settings.diffuse_bounces = 1;
    const PlainPicture want = expect_same_picture(s, 160);
    for (const std::size_t m : {3U, 4U}) {
        Scene other = s;
        other.materials[m].two_sided = true;
        expect_other_picture(want, other);
    }
}

} // namespace
} // namespace razor::test
