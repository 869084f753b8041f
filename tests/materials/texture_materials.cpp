// Which textures a surface has: materials of faces and of instances, several maps, normal maps.
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

} // namespace
} // namespace razor::test
