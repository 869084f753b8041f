// Patches, owners and adjacency.
#include "meshes.h"

#include "razor/surface/adjacency.h"
#include "razor/surface/topology.h"

#include <gtest/gtest.h>

#include <set>

namespace razor::test {
namespace {

TEST(Adjacency, FansRoundAPoint) {
    const Mesh mesh = cube();
    const Adjacency a = build_adjacency(mesh);
    EXPECT_EQ(a.edge_count(), 12);
    for (int p = 0; p < 8; ++p) {
        const int start = a.corners_at_point(p)[0];
        int c = start;
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(a.clockwise(a.counter_clockwise(c)), c);
            c = a.counter_clockwise(c);
            EXPECT_EQ(a.point(c), p);
        }
        EXPECT_EQ(c, start);
        EXPECT_FALSE(is_interior_valence_two(a, p));
    }
    const Mesh folded = pillow(3);
    EXPECT_TRUE(is_interior_valence_two(build_adjacency(folded), 0));
}

TEST(Adjacency, StopsAtEdgesThatAreNotManifold) {
    for (const auto& faces : {std::vector<std::vector<int>>{{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}},
                              std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 1, 4, 5}}}) {
        const Mesh mesh = cage(8, faces);
        const Adjacency a = build_adjacency(mesh);
        EXPECT_EQ(a.clockwise(0), -1);
        EXPECT_EQ(a.counter_clockwise(1), -1);
        EXPECT_EQ(a.corners_at_edge(a.find_edge(1, 0)).size(), faces.size());
    }
}

TEST(Topology, SubFacesOfPolygons) {
    const Mesh mesh = prism(5);
    const Topology t = analyse_topology(mesh);
    ASSERT_EQ(t.patches.size(), 2U * 5 + 5);
    const PatchRecord& patch = t.patches[5 + 2]; // face 1: points 5 to 9
    EXPECT_EQ(patch.face, 1);
    EXPECT_EQ(patch.sub, 2);
    EXPECT_EQ(patch.corner[0], 7);
    EXPECT_EQ(patch.corner[1], patch.side_curve[0]);
    EXPECT_EQ(patch.corner[2], 1);
    EXPECT_EQ(patch.corner[3], patch.side_curve[3]);
    EXPECT_EQ(t.patches[5 + 3].side_curve[2], patch.side_curve[1]);
    EXPECT_EQ(t.curves.size(), 15U + 10U);
}

TEST(Topology, EveryCurveOfAnEdgeIsShared) {
    const Mesh mesh = cage(8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}});
    const Topology t = analyse_topology(mesh);
    ASSERT_EQ(t.patches.size(), 3U);
    EXPECT_EQ(t.patches[0].side_curve[0], t.patches[1].side_curve[0]);
    EXPECT_EQ(t.patches[0].side_curve[0], t.patches[2].side_curve[0]);
    EXPECT_EQ(t.patches[0].side_flags[0], 0);
    EXPECT_EQ(t.patches[1].side_flags[0], side_reversed);
    EXPECT_EQ(t.curves[static_cast<std::size_t>(t.patches[2].side_curve[0])].owner_face, 0);
}

TEST(Topology, BoundaryNoneLeavesTheRimOut) {
    Mesh mesh = quad_grid(5, 5);
    mesh.boundary = BoundaryInterpolation::none;
    const Topology t = analyse_topology(mesh);
    EXPECT_EQ(t.undrawn_faces, 16);
    EXPECT_EQ(t.patches.size(), 9U);
    EXPECT_EQ(t.points[0].owner_face, -1);
}

TEST(Topology, DependsOnTopologyAlone) {
    Mesh mesh = triangle_pole(7), moved = mesh;
    for (glm::dvec3& p : moved.points) {
        p = glm::dvec3(p.y, -3 * p.z, p.x * p.x);
    }
    const Topology a = analyse_topology(mesh), b = analyse_topology(moved);
    EXPECT_EQ(a.controls, b.controls);
    EXPECT_EQ(a.classes.size(), b.classes.size());
}

TEST(Topology, ControlListsHoldEachPointOnce) {
    for (const Mesh& mesh : hard_meshes()) {
        const Topology t = analyse_topology(mesh);
        for (std::size_t f = 0; f < t.faces.size(); ++f) {
            const FaceRecord& face = t.faces[f];
            if (face.face_class < 0 || t.classes[static_cast<std::size_t>(face.face_class)].regular) {
                continue;
            }
            const auto begin = t.controls.begin() + face.control_first;
            EXPECT_EQ(std::set<int>(begin, begin + face.control_count).size(),
                      static_cast<std::size_t>(face.control_count));
        }
    }
}

} // namespace
} // namespace razor::test
