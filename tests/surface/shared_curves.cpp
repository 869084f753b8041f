// Sides resolve to curves and corners to points, whose owners evaluate them where the patch itself would.
#include "meshes.h"
#include "patch_samples.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace razor::test {
namespace {

constexpr int exponent = 2;
constexpr int steps = 1 << exponent;

glm::dvec3 side_point(const Samples& block, int side, int i) {
    const int n = steps + 1;
    const std::array<int, 4> index{i, i * n + steps, steps * n + i, i * n};
    return block.position[static_cast<std::size_t>(index[static_cast<std::size_t>(side)])];
}

/// Largest distance between a patch's own border points and those of the curves and points it names, over the
/// cage size.
double worst_gap(const Mesh& mesh) {
    const Topology topology = analyse_topology(mesh);
    PagePool pool(mesh, topology, 3);
    double worst = 0;
    for (const PatchRecord& patch : topology.patches) {
        const Samples block = pool.block(patch, exponent);
        const bool whole = topology.faces[static_cast<std::size_t>(patch.face)].corner_count == 4;
        for (int side = 0; side < 4; ++side) {
            const std::vector<glm::dvec3> curve = pool.curve(patch.side_curve[side], exponent + 1);
            for (int i = 0; i <= steps; ++i) {
                const double t = curve_parameter(patch.side_flags[side], static_cast<double>(i) / steps);
                const glm::dvec3 shared = curve[static_cast<std::size_t>(t * 2 * steps)];
                worst = std::max(worst, glm::length(shared - side_point(block, side, i)));
            }
        }
        const std::array<glm::dvec3, 4> corner{side_point(block, 0, 0), side_point(block, 0, steps),
                                               side_point(block, 2, steps), side_point(block, 2, 0)};
        for (int i = 0; i < (whole ? 4 : 1); ++i) {
            worst = std::max(worst,
                             glm::length(pool.vertex(patch.corner[i]) - corner[static_cast<std::size_t>(i)]));
        }
        if (!whole) {
            for (const int i : {1, 3}) {
                EXPECT_EQ(patch.corner[i], patch.side_curve[i == 1 ? 0 : 3]);
                const glm::dvec3 middle = pool.curve(patch.corner[i], 1)[1];
                worst = std::max(worst, glm::length(middle - corner[static_cast<std::size_t>(i)]));
            }
            EXPECT_EQ(patch.corner[2], patch.face);
        }
    }
    return worst / extent(mesh);
}

void check(const Mesh& mesh) {
    SCOPED_TRACE(mesh.name);
    EXPECT_LT(worst_gap(mesh), 2e-6);
}

TEST(SharedCurves, OwnersEvaluateWherePatchesDoOnHardCages) {
    for (const Mesh& mesh : hard_meshes()) {
        check(mesh);
    }
}

TEST(SharedCurves, OwnersEvaluateWherePatchesDoOnRealMeshes) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    std::vector<Mesh> meshes = osd_meshes();
    for (const char* path :
         {"makehuman/female_generic.obj", "spot/spot_control_mesh.obj", "spot/spot_quadrangulated.obj"}) {
        meshes.push_back(shared_mesh(path));
    }
    for (const Mesh& mesh : meshes) {
        if (mesh.scheme == Scheme::catmull_clark) {
            check(mesh);
        }
    }
}

TEST(SharedCurves, BothFacesNameTheSameCurve) {
    const Mesh mesh = quad_grid(2, 1);
    const Topology t = analyse_topology(mesh);
    // The shared edge joins points 1 and 4: side 1 of the first face, side 3 of the second.
    EXPECT_EQ(t.patches[0].side_curve[1], t.patches[1].side_curve[3]);
    const CurveRecord& curve = t.curves[static_cast<std::size_t>(t.patches[0].side_curve[1])];
    EXPECT_EQ(curve.owner_face, 0);
    EXPECT_EQ(curve.owner_local, 1);
    EXPECT_EQ(curve.end0, 1);
    EXPECT_EQ(curve.end1, 4);
    EXPECT_EQ(curve.flags, 0);
}

TEST(SharedCurves, UndrawnFacesOwnNothing) {
    Mesh mesh = quad_grid(2, 1);
    mesh.holes = {0};
    const Topology t = analyse_topology(mesh);
    EXPECT_EQ(t.undrawn_faces, 1);
    ASSERT_EQ(t.patches.size(), 1U);
    EXPECT_EQ(t.points[1].owner_face, 1);
    EXPECT_EQ(t.points[0].owner_face, -1);
    EXPECT_EQ(t.curves[static_cast<std::size_t>(t.patches[0].side_curve[3])].owner_face, 1);
    EXPECT_EQ(t.curves[static_cast<std::size_t>(t.patches[0].side_curve[3])].flags, curve_owner_reversed);
}

} // namespace
} // namespace razor::test
