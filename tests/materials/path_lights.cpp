// Pictures of rooms with lights of each kind against paths that are followed one by one in double.
#include "tests/materials/compare_paths.h"
#include "tests/materials/room.h"
#include "tests/materials/skies.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace razor::test {
namespace {

/// A room with that light alone, and surfaces that find lights by chance: rough metal, plastic and a mirror.
Scene room_lit_by(const Light& light) {
    Scene s = room();
    s.lights = {light};
    s.sky = {0.05F, 0.06F, 0.08F};
    s.materials[0].specular = 1;
    s.materials[0].roughness = 0.35F;
    s.meshes[1].material = 3;
    s.meshes.push_back(box("box", {-1.3, 0, -0.5}, {1, 1.1, 0.9}, 25, 4));
    s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0;
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.45F;
    s.settings.diffuse_bounces = 1;
    return s;
}

/// The room lit by it is as it should be; lit by the other it is not.
void expect_light(const char* name, const Light& light, const Light& other, int samples = 320) {
    Scene s = room_lit_by(light);
    s.name = name;
    const PlainPicture want = expect_same_picture(s, samples);
    Scene otherwise = s;
    otherwise.lights = {other};
    expect_other_picture(want, otherwise);
}

TEST(PathsOfLights, Disk) {
    Light disk{.radiance = {6, 5, 4}, .kind = LightKind::disk};
    disk.position = {0.3, 2.6, 0.2};
    disk.direction = {-0.4, -1, -0.3};
    disk.radius = 0.7;
    Light smaller = disk, turned = disk;
    smaller.radius = 0.6;
    turned.direction = {0.4, -1, -0.3};
    expect_light("disk", disk, smaller);
    expect_light("disk", disk, turned);
}

TEST(PathsOfLights, Sphere) {
    Light sphere{.radiance = {6, 5, 4}, .kind = LightKind::sphere};
    sphere.position = {0.5, 1.6, 0.4};
    sphere.radius = 0.4;
    Light smaller = sphere;
    smaller.radius = 0.35;
    expect_light("sphere", sphere, smaller);
}

TEST(PathsOfLights, Point) {
    Light point{.radiance = {6, 5, 4}, .kind = LightKind::point};
    point.position = {0.5, 2, 0.6};
    Light moved = point;
    moved.position.x = 0.3;
    expect_light("point", point, moved);
}

TEST(PathsOfLights, Spot) {
    Light spot{.radiance = {9, 7, 5}, .kind = LightKind::spot};
    spot.position = {0.8, 2.6, 1.2};
    spot.direction = {-1, -2, -1.5};
    spot.cone_angle = 32;
    spot.cone_delta = 14;
    Light sharp = spot, whole = spot;
    sharp.cone_delta = 2;
    whole.kind = LightKind::point;
    expect_light("spot", spot, sharp);
    expect_light("spot", spot, whole);
}

TEST(PathsOfLights, Directional) {
    for (const double radius : {0.0, 20.0}) {
        Light sun{.radiance = {3, 2.8F, 2.5F}, .kind = LightKind::directional};
        sun.direction = {-1, -2, -1.2};
        sun.angular_radius = radius;
        Light wider = sun;
        wider.angular_radius = radius > 0 ? 0 : 20;
        expect_light(radius > 0 ? "directional, 40 degrees wide" : "directional", sun, wider);
    }
}

// Shadow rays to a flat lamp carry what its map shows where they end, not the mean of a triangle.
TEST(PathsOfLights, LampWithAMap) {
    Scene s = room_lit_by({});
    s.name = "a flat lamp with a map";
    s.lights.clear();
    s.sky = {0, 0, 0};
    s.textures.push_back(
        sky_texture(16, 16, [](double u, double) { return glm::vec3(u < 0.25 || u > 0.75 ? 2.0F : 0.05F); }));
    s.textures.back().wrap_u = s.textures.back().wrap_v = Wrap::clamp;
    Mesh lamp = quad("lamp", {0.2, 0.05, -1.2}, {1.4, 0, 0.1}, {0, 0.8, 0.1}, 5);
    lamp.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    lamp.face_texcoords = {0, 1, 2, 3};
    s.meshes.push_back(lamp);
    s.materials.push_back(named("lamp", {0.3F, 0.3F, 0.3F}));
    s.materials.back().emission = {4, 3, 6};
    s.materials.back().emission_map.texture = static_cast<int>(s.textures.size()) - 1;
    s.materials.back().light = true;
    s.settings.edge_pixels = 0.1;
    expect_same_picture(s, 320);
}

/// All of them, more than one of some, beside a mapped sky and a lamp.
TEST(PathsOfLights, AllAtOnce) {
    Scene s = room_lit_by({});
    s.name = "lights of all kinds";
    s.lights.clear();
    for (const LightKind kind : {LightKind::rectangle, LightKind::disk, LightKind::sphere, LightKind::point,
                                 LightKind::spot, LightKind::directional, LightKind::sphere}) {
        Light l{.radiance = {2, 1.8F, 1.5F}, .kind = kind};
        const auto n = static_cast<double>(s.lights.size());
        l.corner = {-1, 2.8, -0.5};
        l.edge_u = {0.8, 0, 0};
        l.edge_v = {0, 0.2, 0.8};
        l.position = {-1.2 + 0.4 * n, 2.5 - 0.1 * n, 1.2 - 0.2 * n};
        l.direction = {0.4 - 0.15 * n, -1, -0.2};
        l.radius = 0.25;
        if (kind == LightKind::directional)
            l.radiance = {0.8F, 0.8F, 0.7F};
        l.angular_radius = 20;
        s.lights.push_back(l);
    }
    set_sky(s, sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.4, 3); }), 200);
    s.sky = {0.4F, 0.4F, 0.4F};
    s.meshes.push_back(quad("panel", {0.7, 0.1, -1.2}, {0.9, 0, 0.1}, {0, 0.8, 0.1}, 5));
    s.materials.push_back(named("panel", {0.3F, 0.3F, 0.3F}));
    s.materials.back().emission = {4, 3, 6};
    s.materials.back().light = true;
    s.settings.edge_pixels = 0.1;
    const PlainPicture want = expect_same_picture(s, 320);
    for (std::size_t k = 0; k < s.lights.size(); ++k) {
        Scene without = s;
        without.lights.erase(without.lights.begin() + static_cast<std::ptrdiff_t>(k));
        expect_other_picture(want, without);
    }
    Scene dark = s;
    dark.materials.back().light = false;
    dark.materials.back().emission = {0, 0, 0};
    expect_other_picture(want, dark);
}

} // namespace
} // namespace razor::test
