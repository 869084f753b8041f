// Faces share pages exactly when one page is right for all of them.
#include "bfr_stencils.h"
#include "meshes.h"
#include "patch_samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

namespace razor::test {
namespace {

/// Largest difference between the weights of a class's page and a member's own stencil.
double worst_weight(const Mesh& mesh, int members_a_class) {
    constexpr int level = 3, exponent = 1, n = 3;
    const Topology topology = analyse_topology(mesh);
    PagePool pool(mesh, topology, level);
    BfrStencils stencils(mesh, level);
    std::map<int, int> tested;
    double worst = 0;
    for (const PatchRecord& patch : topology.patches) {
        const FaceRecord& face = topology.faces[static_cast<std::size_t>(patch.face)];
        if (++tested[face.face_class] > members_a_class * face.corner_count) {
            continue;
        }
        PageKey key;
        key.face_class = face.face_class;
        key.local = patch.sub;
        key.exponent_u = key.exponent_v = exponent;
        const std::vector<float>& page = pool.page(key);
        for (int i = 0; i < n * n; ++i) {
            const PointWeights exact = stencils.at(patch, {(i % n) / 2.0, (i / n) / 2.0});
            worst = std::max(
                worst, differences(exact, topology, face, page, nullptr, static_cast<std::size_t>(i))[0]);
        }
    }
    return worst;
}

/// Pages of Chaikin creases come from Far: LimitSurface tests all their members.
bool has_bfr_stencils(const Mesh& mesh) {
    return mesh.scheme == Scheme::catmull_clark && mesh.crease_method != CreaseMethod::chaikin;
}

std::size_t class_count(const Mesh& mesh) {
    return analyse_topology(mesh).classes.size();
}

TEST(Classes, OnePageServesEveryMemberOnHardCages) {
    for (const Mesh& mesh : hard_meshes()) {
        if (has_bfr_stencils(mesh)) {
            EXPECT_LT(worst_weight(mesh, 1000), 1e-6) << mesh.name;
        }
    }
}

TEST(Classes, OnePageServesEveryMemberOnRealMeshes) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    std::vector<Mesh> meshes = osd_meshes();
    meshes.push_back(shared_mesh("makehuman/female_generic.obj"));
    meshes.push_back(shared_mesh("spot/spot_control_mesh.obj"));
    for (const Mesh& mesh : meshes) {
        if (has_bfr_stencils(mesh)) {
            EXPECT_LT(worst_weight(mesh, 40), 1e-6) << mesh.name;
        }
    }
}

TEST(Classes, TopologicallyEqualFacesShare) {
    EXPECT_EQ(class_count(cube()), 1U);
    // Interior 3 x 3, four corners alike, and sides by distance from their ends as seen from the first
    // corner.
    const Topology t = analyse_topology(quad_grid(7, 7));
    int regular = 0;
    for (const FaceRecord& face : t.faces) {
        regular += t.classes[static_cast<std::size_t>(face.face_class)].regular ? 1 : 0;
    }
    EXPECT_EQ(regular, 25);
    EXPECT_EQ(t.classes.size(), 9U); // regular, 4 corners and 4 sides, each turned another way
    EXPECT_EQ(class_count(quad_pole(360)), 1U);
}

TEST(Classes, TagsAroundTheFaceSeparate) {
    Mesh mesh = quad_grid(7, 7);
    const std::size_t plain = class_count(mesh);
    mesh.creases = {{27, 28, 2.0F}};
    const std::size_t creased = class_count(mesh);
    EXPECT_GT(creased, plain);
    mesh.creases.push_back({28, 29, 3.0F});
    EXPECT_GT(class_count(mesh), creased);
    mesh.creases.clear();
    mesh.corners = {{27, 1.0F}};
    EXPECT_EQ(class_count(mesh), plain + 4); // the four faces round the point
}

TEST(Classes, LaterTagsOfTheSameEdgeCount) {
    Mesh once = quad_grid(6, 6), twice = once;
    once.creases = {{24, 25, 1.0F}};
    twice.creases = {{24, 25, 4.0F}, {25, 24, 1.0F}};
    once.corners = {{30, 2.0F}};
    twice.corners = {{30, 0.5F}, {30, 2.0F}};
    EXPECT_EQ(class_count(once), class_count(twice));
    EXPECT_LT(worst_weight(twice, 1000), 1e-6);
}

TEST(Classes, CountsOnRealMeshes) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    for (const char* path : {"boat/boat.obj", "makehuman/female_generic.obj", "osd/catmark_car.obj"}) {
        const Mesh mesh = shared_mesh(path);
        const Topology t = analyse_topology(mesh);
        fmt::print("  {}: {} faces, {} classes, {} controls, largest exponent {}\n", path, t.faces.size(),
                   t.classes.size(), t.controls.size(), t.max_exponent);
        EXPECT_LT(t.classes.size(), t.faces.size());
        EXPECT_EQ(t.max_exponent, max_exponent_limit);
    }
}

} // namespace
} // namespace razor::test
