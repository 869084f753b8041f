// Surfaces that are lights: what rays to them find is what bounces find of them that look everywhere,
// whatever the surface, the level of detail and the way it is placed.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/parts.h"
#include "tests/materials/skies.h"

#include "razor/frame/emitters.h"
#include "razor/frame/frame.h"
#include "razor/native/render.h"
#include "razor/scene/description.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/textures/shared_exponent.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;

/// A glowing mesh over a floor that is seen from above, the mesh not.
Scene glowing(const Mesh& mesh, Lod lod) {
    Scene s = scene_of(mesh, 24);
    Mesh floor = bilinear(cube_cage());
    floor.name = "floor";
    floor.points = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
    floor.face_sizes = {4};
    floor.face_vertices = {0, 1, 2, 3};
    floor.creases.clear();
    floor.corners.clear();
    floor.material = 1;
    s.meshes.push_back(floor);
    s.graph.groups = {{"scene",
                       {{.name = "mesh", .mesh = 0, .local = {.translate = {0, 2.2, 0}}},
                        {.name = "floor", .mesh = 1, .local = {}}}}};
    s.materials = {{"lamp", {0, 0, 0}}, {"floor", {0.8F, 0.7F, 0.6F}}};
    s.materials[0].emission = {4, 3, 2};
    s.lights.clear();
    s.sky = {0, 0, 0};
    s.camera.position = {0, 0.9, 4};
    s.camera.target = {0, 0, 0.4};
    s.camera.fov_degrees = 45;
    s.settings.lod = lod;
    s.settings.width = s.settings.height = 32;
    s.settings.samples = 16;
    s.settings.light_samples = 4;
    s.settings.edge_pixels = 0.25; // what levels of detail differ by is not the question
    return s;
}

/// Rays to it, and as many bounces as lobes need, against bounces in all directions, which the black mesh
/// ends.
void expect_same_light(Scene s, const std::string& what, double tolerance = 0.015) {
    Scene bounced = s;
    for (Material& m : s.materials)
        m.light = m.emission != glm::vec3(0);
    bounced.settings.bounces = bounced.settings.diffuse_bounces = s.settings.bounces = 1;
    bounced.settings.samples = 512;
    const Parts want = parts_of(bounced, 6), seen = parts_of(s, 6);
    dvec3 all(0), all_seen(0);
    double noise = 0, more_noise = 0;
    for (std::size_t k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) {
            const double error = std::sqrt(want.variance[k][c] + seen.variance[k][c]);
            EXPECT_NEAR(seen.mean[k][c], want.mean[k][c], 5 * error + 2 * tolerance * want.mean[k][c])
                << what << ", part " << k;
        }
        all += want.mean[k];
        all_seen += seen.mean[k];
        noise += seen.variance[k].y;
        more_noise += want.variance[k].y;
    }
    fmt::print("  {}: {:+.2f} %, noise {:.4f} against {:.4f} with 32 times the samples\n", what,
               100 * (all_seen.y / all.y - 1), std::sqrt(noise) / all.y, std::sqrt(more_noise) / all.y);
    EXPECT_NEAR(all_seen.y / all.y, 1, tolerance) << what;
    EXPECT_GT(all.y, 0.1) << what << ": no light, no test";
}

class EmittersOf : public testing::TestWithParam<Lod> {};

TEST_P(EmittersOf, AllKindsOfSurfaces) {
    for (const Mesh& mesh : {urchin_cage(), torus_cage(6, 5), bilinear(stretched(torus_cage(5, 4))),
                             bevelled_slab(), tapered_cage()})
        expect_same_light(glowing(mesh, GetParam()), mesh.name);
}

INSTANTIATE_TEST_SUITE_P(Levels, EmittersOf, testing::Values(Lod::object, Lod::recursive),
                         [](const auto& info) {
                             return "lod" + std::to_string(static_cast<int>(info.param));
                         });

TEST(Emitters, OfOneSide) {
    Scene s = glowing(torus_cage(6, 5), Lod::object);
    s.meshes[0].holes = {0, 1, 2, 7, 8}; // so that both sides are seen
    expect_same_light(s, "open, of two sides");
    s.materials[0].two_sided = false;
    expect_same_light(s, "open, of its outside");
}

TEST(Emitters, PlacedAnywhere) {
    Scene s = glowing(urchin_cage(), Lod::recursive);
    s.materials[0].two_sided = false;
    auto& placements = s.graph.groups[0].placements;
    placements[0].local = {.scale = {-0.4, 0.5, 0.3}, .rotate = {10, 50, 0}, .translate = {1.2, 1.2, 0.3}};
    placements.push_back(
        {.name = "other",
         .mesh = 0,
         .local = {.scale = glm::dvec3(0.3), .rotate = {0, 20, 70}, .translate = {-1, 0.8, 0}}});
    expect_same_light(s, "mirrored and stretched");
}

TEST(Emitters, OfFaces) {
    Scene s = glowing(torus_cage(6, 5), Lod::object);
    s.materials.push_back({"other", {0, 0, 0}});
    s.materials.push_back({"dark", {0, 0, 0}});
    s.materials[2].emission = {1, 2, 9};
    for (std::size_t f = 0; f < s.meshes[0].face_sizes.size(); ++f)
        s.meshes[0].face_materials.push_back(f % 3 == 0 ? 0 : f % 3 == 1 ? 2 : 3);
    expect_same_light(s, "some faces of two lights");
}

TEST(Emitters, WithMaps) {
    Scene s = glowing(bevelled_slab(), Lod::object);
    Mesh& mesh = s.meshes[0];
    mesh.points = {{-1, 0, -1}, {1, 0, -1}, {1, 0.3, 1}, {-1, 0, 1}};
    mesh.face_sizes = {4};
    mesh.face_vertices = {0, 1, 2, 3};
    mesh.creases.clear();
    mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_texcoords = {0, 1, 2, 3};
    s.textures.push_back(
        sky_texture(16, 16, [](double u, double v) { return glm::vec3(u > 0.5 ? 3 : 0.1, v, 0.5); }));
    s.textures[0].wrap_u = s.textures[0].wrap_v = Wrap::clamp;
    s.materials[0].emission_map.texture = 0;
    expect_same_light(s, "with a map");
    mesh.points[2].y = 0;
    expect_same_light(s, "flat, with a map");
}

TEST(Emitters, InMetal) {
    for (const float roughness : {0.2F, 0.5F}) {
        Scene s = glowing(urchin_cage(), Lod::recursive);
        s.materials[1].metallic = 1;
        s.materials[1].roughness = roughness;
        Scene only = s;
        expect_same_light(s, fmt::format("in metal of roughness {}", roughness));
    }
}

// Its triangles have the area of the surface, and chances by area and radiance.
TEST(Emitters, AreAsLargeAsTheSurface) {
    Scene s = glowing(bilinear(cube_cage()), Lod::object);
    s.materials[0].light = true;
    Frame frame(s, {});
    const FrameHeader& h = frame.header();
    ASSERT_EQ(h.emitter_count, 12);
    double area = 0;
    for (int k = 0; k < h.emitter_count; ++k) {
        const EmitterRecord& r = h.emitters.get()[k];
        const dvec3 u(r.edge_u[0], r.edge_u[1], r.edge_u[2]), v(r.edge_v[0], r.edge_v[1], r.edge_v[2]);
        area += glm::length(glm::cross(u, v)) / 2;
    }
    ASSERT_EQ(h.emitter_group_count, 6);
    for (int g = 0; g < h.emitter_group_count; ++g) {
        const EmitterGroup& group = h.emitter_groups.get()[g];
        EXPECT_NEAR(group.chance, 1.0 / 6, 1e-6);
        ASSERT_EQ(group.count, 2);
        EXPECT_EQ(group.first, 2 * g);
        const float* sums = h.emitter_sums.get() + group.sums;
        EXPECT_EQ(sums[0], 0);
        EXPECT_NEAR(sums[1], 0.5, 1e-6);
        EXPECT_EQ(sums[2], 1);
        EXPECT_EQ(h.emitter_nodes.get()[group.leaf].second, -1 - g);
    }
    EXPECT_NEAR(h.materials.get()[0].light_density * area, 1, 1e-5);
    EXPECT_EQ(h.materials.get()[1].light_density, 0);
}

TEST(Emitters, CostNothingWhereNoneIsDeclared) {
    const Scene s = glowing(urchin_cage(), Lod::object);
    Frame frame(s, {});
    EXPECT_EQ(frame.header().emitter_count, 0);
    EXPECT_EQ(frame.header().emitters.get(), nullptr);
}

/// All that a frame shows, whatever was made before it.
std::vector<float> picture_of(Frame& frame, const KernelTable& kernels) {
    run_workers(frame, kernels);
    const FrameHeader& h = frame.header();
    return {h.film.get(), h.film.get() + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes};
}

/// The message with which a scene is refused; empty: it is not.
std::string refusal(const Scene& scene) {
    try {
        const Frame frame(scene, {});
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

// Rays go to triangles of the limit surface: not to where heights move it, nor beside holes.
TEST(Emitters, AreWhereTheirTrianglesAre) {
    Mesh cube = cube_cage();
    cube.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t i = 0; i < cube.face_vertices.size(); ++i)
        cube.face_texcoords.push_back(static_cast<int>(i % 4));
    Scene s = glowing(cube, Lod::object);
    s.materials[0].light = true;
    s.textures.resize(2);
    s.textures[0].name = "bumps";
    s.textures[0].pattern.emplace().space = PatternSpace::texture;
    const auto picture = std::make_shared<TexturePyramid>(); // of one texel
    picture->levels.push_back({1, 1, std::vector<std::uint32_t>(16, pack_shared_exponent(glm::vec3(1))), {}});
    s.textures[1].name = "holes";
    s.textures[1].pyramid = picture;
    EXPECT_EQ(refusal(s), "");
    Scene moved = s;
    moved.materials[0].displacement_map.texture = 0;
    EXPECT_NE(refusal(moved).find("material 'lamp' is a light and is displaced"), std::string::npos)
        << refusal(moved);
    Scene cut = s;
    cut.materials[0].albedo_map.texture = 1;
    cut.materials[0].alpha_cutoff = 0.5F;
    EXPECT_EQ(refusal(cut), "") << "a picture that is opaque";
    picture->levels[0].opacity = picture->levels[0].texels;
    EXPECT_NE(refusal(cut).find("'lamp' is a light and has holes"), std::string::npos) << refusal(cut);
    cut.materials[0].alpha_cutoff = 0;
    EXPECT_EQ(refusal(cut), "");
    // What bounces alone find, what is dark, and what nothing is made of.
    Scene bounced = moved, dark = moved, unused = moved;
    bounced.materials[0].light = false;
    dark.materials[0].emission = {0, 0, 0};
    unused.meshes[0].material = 1;
    for (const Scene& fine : {bounced, dark, unused})
        EXPECT_EQ(refusal(fine), "");
}

// A curved lamp whose map follows texture coordinates, close to what it lights: what is kept of its blended
// blocks is the same whether a ray to the lamp or one that hit it made it, in whatever memory.
TEST(Emitters, MapsOfTextureCoordinatesShowTheSameWhateverWasMadeBefore) {
    const Scene scene = build_scene(parse_scene_file(R"(
[settings]
size = [64, 48]
samples = 4
[camera]
position = [0, 6, 10]
target = [0, 0.6, 0]
fov = 40
[sky]
radiance = 0
[[texture]]
name = "checks"
pattern = "checker"
space = "texture"
size = 0.1
high = [1, 0.3, 0.1]
[[material]]
name = "floor"
albedo = 0.5
[[material]]
name = "lamp"
emission_map = "checks"
emission = 2
light = true
[[mesh]]
name = "floor"
shape = "plane"
scheme = "bilinear"
material = "floor"
[mesh.parameters]
width = 30
depth = 30
[[mesh]]
name = "box"
shape = "box"
[[object]]
mesh = "box"
material = "lamp"
translate = [1, 0.7, 2]
rotate = [0, 25, 0]
[[object]]
mesh = "floor"
[[object]]
mesh = "box"
material = "floor"
translate = [1, 0.7, 0]
rotate = [0, 25, 0]
)",
                                                     "lamp.toml", {}));
    for (const KernelTable* target : best_target()) {
        Frame frame(scene, {.workers = 1});
        const std::vector<float> first = picture_of(frame, *target);
        frame.reset();
        EXPECT_TRUE(picture_of(frame, *target) == first) << "in memory that was used before";
        Frame eager(scene, {.workers = 1});
        eager.build_all(*target);
        EXPECT_TRUE(picture_of(eager, *target) == first) << "with everything built";
        float most = 0;
        for (const float x : first)
            most = std::max(most, std::isfinite(x) ? x : 0);
        EXPECT_GT(most, 1);
    }
}

} // namespace
} // namespace razor::test
