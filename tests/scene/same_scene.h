// Exact equality of scenes, with messages.
#pragma once

#include "razor/scene/light_fields.h"
#include "razor/scene/scene.h"

#include <gtest/gtest.h>

namespace razor {

inline void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.scheme, b.scheme);
    EXPECT_EQ(a.points, b.points) << a.name;
    EXPECT_EQ(a.rest, b.rest) << a.name;
    EXPECT_EQ(a.face_sizes, b.face_sizes);
    EXPECT_EQ(a.face_vertices, b.face_vertices);
    EXPECT_EQ(a.texcoords, b.texcoords);
    EXPECT_EQ(a.face_texcoords, b.face_texcoords);
    EXPECT_EQ(a.holes, b.holes);
    EXPECT_EQ(a.boundary, b.boundary);
    EXPECT_EQ(a.face_varying, b.face_varying);
    EXPECT_EQ(a.crease_method, b.crease_method);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.face_materials, b.face_materials);
    EXPECT_EQ(a.edge_length, b.edge_length);
    ASSERT_EQ(a.creases.size(), b.creases.size());
    for (std::size_t i = 0; i < a.creases.size(); ++i) {
        EXPECT_EQ(a.creases[i].v0, b.creases[i].v0);
        EXPECT_EQ(a.creases[i].v1, b.creases[i].v1);
        EXPECT_EQ(a.creases[i].sharpness, b.creases[i].sharpness);
    }
    ASSERT_EQ(a.corners.size(), b.corners.size());
    for (std::size_t i = 0; i < a.corners.size(); ++i) {
        EXPECT_EQ(a.corners[i].vertex, b.corners[i].vertex);
        EXPECT_EQ(a.corners[i].sharpness, b.corners[i].sharpness);
    }
}

inline void expect_same(const Camera& a, const Camera& b) {
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.up, b.up);
    EXPECT_EQ(a.projection, b.projection);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.fov_degrees, b.fov_degrees);
    EXPECT_EQ(a.aperture_radius, b.aperture_radius);
    EXPECT_EQ(focus_distance(a), focus_distance(b));
}

inline void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.settings.width, b.settings.width);
    EXPECT_EQ(a.settings.height, b.settings.height);
    EXPECT_EQ(a.settings.crop, b.settings.crop);
    EXPECT_EQ(a.settings.filter, b.settings.filter);
    EXPECT_EQ(a.settings.samples, b.settings.samples);
    EXPECT_EQ(a.settings.light_samples, b.settings.light_samples);
    EXPECT_EQ(a.settings.sky_samples, b.settings.sky_samples);
    EXPECT_EQ(a.settings.bounces, b.settings.bounces);
    EXPECT_EQ(a.settings.diffuse_bounces, b.settings.diffuse_bounces);
    EXPECT_EQ(a.settings.noise_threshold, b.settings.noise_threshold);
    EXPECT_EQ(a.settings.seed, b.settings.seed);
    EXPECT_EQ(a.sky_map, b.sky_map);
    EXPECT_EQ(a.settings.edge_pixels, b.settings.edge_pixels);
    EXPECT_EQ(a.settings.lod, b.settings.lod);
    expect_same(a.camera, b.camera);
    ASSERT_EQ(a.dicing_camera.has_value(), b.dicing_camera.has_value());
    if (a.dicing_camera)
        expect_same(*a.dicing_camera, *b.dicing_camera);
    EXPECT_EQ(a.sky, b.sky);
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        EXPECT_EQ(a.lights[i].kind, b.lights[i].kind);
        visit_light_fields(
            a.lights[i].kind,
            [](std::string_view name, Range, bool, const auto& x, const auto& y) { EXPECT_EQ(x, y) << name; },
            a.lights[i], b.lights[i]);
    }
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        EXPECT_EQ(a.textures[i].name, b.textures[i].name);
        EXPECT_EQ(a.textures[i].file, b.textures[i].file);
        EXPECT_EQ(a.textures[i].pattern, b.textures[i].pattern);
        EXPECT_EQ(a.textures[i].linear, b.textures[i].linear);
        EXPECT_EQ(a.textures[i].wrap_u, b.textures[i].wrap_u);
        EXPECT_EQ(a.textures[i].wrap_v, b.textures[i].wrap_v);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        EXPECT_EQ(a.materials[i].name, b.materials[i].name);
        EXPECT_EQ(a.materials[i].albedo, b.materials[i].albedo);
        EXPECT_EQ(a.materials[i], b.materials[i]) << a.materials[i].name;
    }
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        expect_same(a.meshes[i], b.meshes[i]);
    }
}

} // namespace razor
