#include "tests/materials/room.h"

#include "tests/materials/skies.h"

#include <glm/trigonometric.hpp>

#include <cmath>
#include <vector>

namespace razor::test {

using glm::dvec3;

namespace {

Mesh of_faces(const char* name, std::vector<dvec3> points, const std::vector<std::vector<int>>& faces,
              int material) {
    Mesh m;
    m.name = name;
    m.scheme = Scheme::bilinear;
    m.points = std::move(points);
    for (const std::vector<int>& face : faces) {
        m.face_sizes.push_back(static_cast<int>(face.size()));
        m.face_vertices.insert(m.face_vertices.end(), face.begin(), face.end());
    }
    m.edge_length = 1;
    m.material = material;
    return m;
}

} // namespace

Mesh quad(const char* name, const dvec3& corner, const dvec3& u, const dvec3& v, int material) {
    return of_faces(name, {corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2, 3}}, material);
}

/// Turned about its upright axis.
Mesh box(const char* name, const dvec3& low, const dvec3& edges, double degrees, int material) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    std::vector<dvec3> points;
    for (int k = 0; k < 8; ++k) {
        const dvec3 p = edges * dvec3(k & 1, k >> 1 & 1, k >> 2);
        points.push_back(low + dvec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x));
    }
    return of_faces(name, points,
                    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}},
                    material);
}

/// Of triangles, 8 around and 4 high.
Mesh ball(const char* name, const dvec3& middle, double radius, int material) {
    std::vector<dvec3> points{middle + dvec3(0, radius, 0)};
    std::vector<std::vector<int>> faces;
    for (int j = 1; j < 4; ++j)
        for (int i = 0; i < 8; ++i) {
            const double a = glm::radians(45.0 * j), b = glm::radians(45.0 * i);
            points.push_back(
                middle + radius * dvec3(std::sin(a) * std::sin(b), std::cos(a), std::sin(a) * std::cos(b)));
        }
    points.push_back(middle - dvec3(0, radius, 0));
    const auto at = [](int j, int i) { return 1 + (j - 1) * 8 + i % 8; };
    for (int i = 0; i < 8; ++i) {
        faces.push_back({0, at(1, i), at(1, i + 1)});
        for (int j = 1; j < 3; ++j) {
            faces.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            faces.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
        faces.push_back({25, at(3, i + 1), at(3, i)});
    }
    return of_faces(name, std::move(points), faces, material);
}

Material named(const char* name, const glm::vec3& albedo) {
    Material m;
    m.name = name;
    m.albedo = albedo;
    return m;
}

/// A floor and two walls, a light above and a sky.
Scene room() {
    Scene s;
    s.name = "room";
    s.meshes = {quad("floor", {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 0),
                quad("back", {-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, 1),
                quad("left", {-2, 0, -2}, {0, 3, 0}, {0, 0, 4}, 2)};
    s.materials = {named("floor", {0.7F, 0.7F, 0.6F}), named("back", {0.3F, 0.6F, 0.7F}),
                   named("left", {0.8F, 0.3F, 0.2F})};
    Light l;
    l.corner = {-1, 3, -1};
    l.edge_u = {1.6, 0, 0};
    l.edge_v = {0, 0, 1.4};
    l.radiance = {4, 3.5F, 3};
    s.lights = {l};
    s.sky = {0.3F, 0.4F, 0.5F};
    s.camera.position = {1.6, 2, 5};
    s.camera.target = {-0.2, 0.8, 0};
    s.camera.fov_degrees = 38;
    s.settings = {
        .width = room_size, .height = room_size, .samples = 32, .light_samples = 2, .sky_samples = 2};
    return s;
}

Scene full_room() {
    Scene s = room();
    set_sky(s, sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.2, 20); }));
    s.textures.push_back(sky_texture(16, 16, [](double u, double v) { return glm::vec3(u, v, 0.5); }));
    s.meshes[0].texcoords = {{0, 0}, {3, 0}, {3, 2}, {0, 2}};
    s.meshes[0].face_texcoords = {0, 1, 2, 3};
    s.materials[0].albedo_map.texture = s.materials[0].normal_map.texture = 1;
    s.materials[0].coat = 0.5F;
    s.materials[0].coat_roughness = 0.2F;
    s.meshes.push_back(ball("ball", {-0.4, 0.8, 0}, 0.8, 3));
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.4F;
    s.meshes.push_back(box("glass", {0.3, 0.1, 0.6}, {0.7, 0.9, 0.6}, 30, 4));
    s.materials.push_back(named("glass", {0.9F, 1, 0.9F}));
    s.materials.back().specular = s.materials.back().transmission = 1;
    s.materials.back().roughness = 0.1F;
    s.textures.push_back(
        rgba_texture(16, 16, [](double u, double v) { return glm::vec4(v, 0.5, u, 0.2 + 0.6 * u * v); }));
    Mesh cushion = box("cushion", {0.2, 0, -1.4}, {0.8, 0.5, 0.8}, 10, 5);
    cushion.scheme = Scheme::catmull_clark;
    cushion.edge_length = 0.125;
    for (const dvec3& p : cushion.points)
        cushion.texcoords.emplace_back(2 * p.x, p.y - p.z);
    cushion.face_texcoords = cushion.face_vertices;
    s.meshes.push_back(cushion);
    s.materials.push_back(named("velvet", {0.2F, 0.1F, 0.1F}));
    s.materials.back().sheen = {1, 0.9F, 0.8F};
    s.materials.back().sheen_roughness = 0.9F;
    s.materials.back().sheen_map.texture = s.materials.back().sheen_roughness_map.texture = 2;
    s.settings.samples = 4;
    s.settings.diffuse_bounces = 1;
    return s;
}

} // namespace razor::test
