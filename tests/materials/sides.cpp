// What is seen from the front only is not there for rays from behind: of cameras, bounces and to lights; by
// every scheme, level of detail and way of placing it.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/check/mesh_report.h"
#include "razor/frame/frame.h"
#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace razor::test {
namespace {

constexpr const char* layers[] = {"R", "G", "B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "albedo.R"};

Film shown(const Scene& scene, const std::string& target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    return render_native(scene, options).film;
}

/// Pixels of which some layer differs by more than a hundredth.
int differing(const Film& a, const Film& b) {
    std::vector<bool> differs(a.pixel_count(), false);
    for (const char* name : layers) {
        const std::vector<float>& x = a.find(name)->values;
        const std::vector<float>& y = b.find(name)->values;
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!(x[i] == y[i]) && !(std::abs(x[i] - y[i]) <= 0.01F))
                differs[i] = true;
    }
    return static_cast<int>(std::count(differs.begin(), differs.end(), true));
}

Scene one_sided(Scene scene) {
    for (Material& m : scene.materials)
        m.two_sided = false;
    return scene;
}

Scene everything(Scene scene) {
    scene.settings.everything = true;
    return scene;
}

/// Between a floor and a lamp; seen from the front if `facing`.
Scene board(bool facing, Scheme scheme) {
    Scene s = scene_of(bilinear(cube_cage()), 8);
    Mesh& floor = s.meshes[0];
    floor.points = {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}};
    floor.face_sizes = {4};
    floor.face_vertices = {0, 1, 2, 3};
    Mesh board = floor;
    board.name = "board";
    board.scheme = scheme;
    board.boundary = BoundaryInterpolation::edge_and_corner;
    board.points = {{-1, 0.3, 0}, {1, 0.3, 0}, {1, 1.5, 0.1}, {-1, 1.4, 0}};
    if (!facing)
        std::reverse(board.face_vertices.begin(), board.face_vertices.end());
    board.material = 1;
    s.meshes.push_back(board);
    s.materials = {{"floor", {0.5F, 0.6F, 0.7F}}, {"board", {0.8F, 0.2F, 0.1F}}};
    Light lamp;
    lamp.kind = LightKind::point;
    lamp.position = {0.2, 3, -3}; // rays to it meet the side of the board that the camera sees
    lamp.radiance = glm::vec3(20);
    s.lights = {lamp};
    s.sky = {0, 0, 0}; // which comes from all sides
    s.camera.position = {0.4, 2, 6};
    s.camera.target = {0, 0.6, 0};
    return s;
}

class Sides : public testing::TestWithParam<Lod> {};

TEST_P(Sides, BacksAreNotThere) {
    for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark})
        for (const bool glossy : {false, true}) {
            Scene back = board(false, scheme), front = board(true, scheme);
            for (Scene* s : {&back, &front}) {
                s->settings.lod = GetParam();
                s->settings.bounces = 2;
                s->materials[0].metallic = glossy ? 1.0F : 0.0F; // mirrors the side that it sees
                s->materials[0].roughness = 0.1F;
            }
            Scene without = back;
            without.meshes.pop_back();
            for (const KernelTable* target : best_target()) {
                const Film none = shown(without, target->name);
                EXPECT_LE(differing(shown(one_sided(back), target->name), none), 2);
                EXPECT_GT(differing(shown(back, target->name), none), 80) << "no test";
                EXPECT_LE(differing(shown(one_sided(front), target->name), shown(front, target->name)), 2);
            }
        }
}

// From inside nothing of them, from outside no difference, whatever turns, mirrors or bends them.
TEST_P(Sides, ClosedBodiesHaveOutsidesOnly) {
    for (const Mesh& mesh : {torus_cage(6, 5), urchin_cage(), bilinear(stretched(cube_cage())),
                             bevelled_slab(), tapered_cage()}) {
        Scene s = instances_of(mesh, 12);
        s.settings.lod = GetParam();
        const std::string target = native_targets().back()->name;
        const Film both = shown(s, target), outside = shown(one_sided(s), target);
        // Rays that leave a surface see others than those that found them, within what levels differ by: a
        // back that they then meet at once is one that they should not.
        EXPECT_LE(differing(both, outside), GetParam() == Lod::object ? 0 : 10) << mesh.name;
        for (const char* name : {"depth.Z", "normal.X"})
            EXPECT_EQ(both.find(name)->values, outside.find(name)->values) << mesh.name;
        Scene inside = scene_of(mesh, 12);
        inside.settings.lod = GetParam();
        inside.camera.position = inside.camera.target;
        if (mesh.name == "torus")
            inside.camera.position.x += 1;
        inside.camera.target = inside.camera.position + glm::dvec3(0.3, 0.2, 1);
        const Film seen = shown(one_sided(inside), target);
        if (mesh.name == "torus")
            continue; // its other side faces the camera
        for (const float depth : seen.find("depth.Z")->values)
            EXPECT_TRUE(std::isinf(depth)) << mesh.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Levels, Sides,
                         testing::Values(Lod::object, Lod::recursive, Lod::patch, Lod::paper, Lod::camera),
                         [](const auto& info) {
                             return "lod" + std::to_string(static_cast<int>(info.param));
                         });

// Two boards at one place, back to back: each shows its own colour to its own side.
TEST(OneSided, BackToBack) {
    for (const bool turned : {false, true}) {
        Scene s = board(true, Scheme::bilinear);
        Mesh back = board(false, Scheme::bilinear).meshes[1];
        back.name = "back";
        back.material = 2;
        s.meshes.push_back(back);
        if (turned)
            std::swap(s.meshes[1], s.meshes[2]);
        s.materials.push_back({"back", {0.1F, 0.2F, 0.9F}});
        Scene alone = s;
        alone.meshes.erase(alone.meshes.begin() + (turned ? 1 : 2));
        for (const double z : {6.0, -6.0}) {
            Scene pair = one_sided(s), single = alone;
            single.materials[1] = s.materials[z > 0 ? 1 : 2];
            pair.camera.position.z = single.camera.position.z = z;
            EXPECT_EQ(shown(pair, "auto").find("albedo.R")->values,
                      shown(single, "auto").find("albedo.R")->values);
        }
    }
}

// Of a face each, in kernels with and without anything else.
TEST(OneSided, FacesHaveTheirOwn) {
    Scene s = board(false, Scheme::bilinear);
    s.materials[1].two_sided = false;
    s.materials.push_back({"other", {0.1F, 0.2F, 0.9F}});
    Mesh& mesh = s.meshes[1];
    mesh.points.insert(mesh.points.end(), {{1, 0.3, -1}, {3, 0.3, -1}, {3, 1.5, -1}, {1, 1.4, -1}});
    mesh.face_sizes = {4, 4};
    mesh.face_vertices = {3, 2, 1, 0, 7, 6, 5, 4};
    mesh.face_materials = {1, 2};
    const Film film = shown(s, "auto");
    Scene rest = s;
    rest.meshes[1].face_sizes = {4};
    rest.meshes[1].face_vertices = {7, 6, 5, 4};
    rest.meshes[1].face_materials = {2};
    EXPECT_LE(differing(film, shown(rest, "auto")), 2);
    EXPECT_EQ(film.find("R")->values, shown(everything(s), "auto").find("R")->values);
}

// Light leaves glass by the side that it did not come in by.
TEST(OneSided, WhatLetsLightThroughHasTwoSides) {
    Scene s = scene_of(torus_cage(6, 5), 12);
    s.materials[0].transmission = s.materials[0].specular = 1;
    s.settings.bounces = 4;
    EXPECT_EQ(differing(shown(s, "auto"), shown(one_sided(s), "auto")), 0);
}

TEST(OneSided, CostsNothingWhereNothingIs) {
    const Scene s = scene_of(torus_cage(6, 5), 12);
    Frame frame(s, {});
    EXPECT_EQ(frame.header().one_sided, 0);
    EXPECT_EQ(frame.header().materials.get(), nullptr);
    Frame other(one_sided(s), {});
    EXPECT_EQ(other.header().one_sided, 1);
    EXPECT_EQ(other.plan().look, look_matte);
    EXPECT_EQ(shown(one_sided(s), "auto").find("R")->values,
              shown(everything(one_sided(s)), "auto").find("R")->values);
}

// Rays that are kept inside to see whether any escapes are to meet it.
TEST(OneSided, IsCheckedFromInside) {
    const Scene s = one_sided(scene_of(torus_cage(6, 5), 12));
    const Scene closed = check::closed_part(s, {check::examine(s.meshes[0])});
    EXPECT_TRUE(closed.materials[0].two_sided);
}

} // namespace
} // namespace razor::test
