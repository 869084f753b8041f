// Patches of bilinear meshes.
#include "meshes.h"

#include "razor/surface/bilinear_patches.h"
#include "razor/surface/topology.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace razor::test {
namespace {

glm::dvec3 doubled_area(const Mesh& mesh, const PatchRecord& patch) {
    const auto at = [&](int i) { return mesh.points[static_cast<std::size_t>(patch.corner[i])]; };
    return glm::cross(at(1) - at(0), at(2) - at(0));
}

TEST(Bilinear, KindsOfFaces) {
    Mesh mesh = cage(9, {{0, 1, 2, 3}, {0, 1, 4}, {3, 2, 5, 6, 7}, {1, 2, 8, 4}}, Scheme::bilinear);
    mesh.points = {{0, 0, 0}, {1, 0, 0},     {1, 1, 0}, {0, 1, 0},  {0.5, -1, 2},
                   {1, 2, 0}, {0.5, 1.5, 0}, {0, 2, 0}, {3, 0.5, 1}};
    validate_mesh(mesh);
    const Topology t = analyse_topology(mesh);
    ASSERT_EQ(t.patches.size(), 6U);
    EXPECT_EQ(t.patches[0].kind, PatchKind::flat_quad);
    EXPECT_EQ(t.patches[1].kind, PatchKind::flat_triangle);
    for (std::size_t i = 2; i < 5; ++i) {
        EXPECT_EQ(t.patches[i].kind, PatchKind::flat_triangle);
        EXPECT_GE(doubled_area(mesh, t.patches[i]).z, 0);
        EXPECT_EQ(t.patches[i].sub, static_cast<int>(i) - 2);
    }
    EXPECT_EQ(t.patches[5].kind, PatchKind::bilinear);
    EXPECT_TRUE(t.classes.empty());
    EXPECT_EQ(t.faces[2].face_class, -1);
    EXPECT_EQ(t.faces[2].control_count, 5);
    EXPECT_EQ(t.controls[static_cast<std::size_t>(t.faces[2].control_first)], 3);
}

TEST(Bilinear, NonPlanarPolygonsAreSplitAtMidpointsAndCentre) {
    Mesh mesh = prism(5);
    mesh.scheme = Scheme::bilinear;
    mesh.points[7].z += 1;
    const Topology t = analyse_topology(mesh);
    std::vector<PatchRecord> split;
    for (const PatchRecord& patch : t.patches) {
        if (patch.face == 1) {
            split.push_back(patch);
        }
    }
    ASSERT_EQ(split.size(), 5U);
    EXPECT_EQ(split[2].kind, PatchKind::bilinear);
    EXPECT_EQ(split[2].corner[0], 7);
    EXPECT_EQ(split[2].corner[1], split[2].side_curve[0]);
    EXPECT_EQ(split[2].corner[2], 1);
    EXPECT_EQ(split[2].side_flags[0], side_half);                 // 7 -> 8
    EXPECT_EQ(split[2].side_flags[3], side_half | side_reversed); // along 6 -> 7 from 7
    const CurveRecord& spoke = t.curves[static_cast<std::size_t>(split[2].side_curve[1])];
    EXPECT_EQ(spoke.flags, curve_spoke);
    EXPECT_EQ(spoke.owner_face, 1);
    EXPECT_EQ(spoke.owner_local, 5 + 2);
    EXPECT_EQ(spoke.end0, split[2].side_curve[0]);
    EXPECT_EQ(split[3].side_curve[2], split[2].side_curve[1]);
}

TEST(Bilinear, SidesOfTrianglesAreCageEdgesOrNone) {
    Mesh mesh = cage(5, {{4, 3, 2, 1, 0}}, Scheme::bilinear);
    mesh.points = {{0, 0, 0}, {0, 2, 0}, {0.5, 0.5, 0}, {2, 2, 0}, {2, 0, 0}};
    const Topology t = analyse_topology(mesh);
    ASSERT_EQ(t.patches.size(), 3U);
    int named = 0;
    for (const PatchRecord& patch : t.patches) {
        EXPECT_EQ(patch.corner[3], patch.corner[2]);
        EXPECT_EQ(patch.side_curve[2], -1);
        const int from[4] = {0, 1, 3, 0}, to[4] = {1, 2, 2, 3};
        for (const int side : {0, 1, 3}) {
            if (patch.side_curve[side] < 0) {
                continue;
            }
            ++named;
            const CurveRecord& curve = t.curves[static_cast<std::size_t>(patch.side_curve[side])];
            const bool reversed = (patch.side_flags[side] & side_reversed) != 0;
            EXPECT_EQ(patch.corner[from[side]], reversed ? curve.end1 : curve.end0);
            EXPECT_EQ(patch.corner[to[side]], reversed ? curve.end0 : curve.end1);
        }
    }
    EXPECT_EQ(named, 5);
}

TEST(Bilinear, PlanarityIsRelativeToTheFace) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        std::vector<glm::dvec3> quad{{0, 0, 0}, {1, 0, 1e-5}, {1, 1, 0}, {0, 1, 0}};
        for (glm::dvec3& p : quad) {
            p = p * scale + glm::dvec3(100 * scale);
        }
        EXPECT_EQ(project_if_planar(quad).size(), 4U);
        quad[1].z += 1e-2 * scale;
        EXPECT_TRUE(project_if_planar(quad).empty());
    }
}

TEST(Bilinear, ConcaveQuadsAndFacesWithoutArea) {
    Mesh mesh = cage(6, {{0, 1, 2, 3}, {0, 1, 4, 5}}, Scheme::bilinear);
    mesh.points = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}, {3, 0, 0}, {4, 0, 0}};
    const Topology t = analyse_topology(mesh);
    EXPECT_EQ(t.patches[0].kind, PatchKind::flat_triangle);
    EXPECT_EQ(t.patches[1].kind, PatchKind::flat_triangle);
    EXPECT_NEAR(doubled_area(mesh, t.patches[0]).z + doubled_area(mesh, t.patches[1]).z, 2.0, 1e-12);
    EXPECT_EQ(t.patches[2].kind, PatchKind::flat_quad);
}

TEST(Bilinear, PolygonWithAHoleJoinedByABridge) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    // The bridge names two points twice, which a reader may refuse; so the file is read here.
    std::ifstream file(std::filesystem::path(RAZOR_SHARED_SCENES) / "odd/concave_polygon.obj");
    Mesh mesh;
    mesh.scheme = Scheme::bilinear;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            glm::dvec3& p = mesh.points.emplace_back(0);
            words >> p.x >> p.y >> p.z;
        } else if (word == "f") {
            while (words >> word) {
                mesh.face_vertices.push_back(std::stoi(word) - 1);
            }
            mesh.face_sizes.push_back(static_cast<int>(mesh.face_vertices.size()));
        }
    }
    ASSERT_EQ(mesh.face_sizes, std::vector<int>{66});
    validate_mesh(mesh);
    const Topology t = analyse_topology(mesh);
    ASSERT_EQ(t.patches.size(), 64U);
    glm::dvec3 polygon(0), triangles(0);
    const glm::dvec3 origin = mesh.points[static_cast<std::size_t>(mesh.face_vertices[0])];
    for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i) {
        polygon += glm::cross(
            mesh.points[static_cast<std::size_t>(mesh.face_vertices[i])] - origin,
            mesh.points[static_cast<std::size_t>(mesh.face_vertices[(i + 1) % mesh.face_vertices.size()])] -
                origin);
    }
    for (const PatchRecord& patch : t.patches) {
        const glm::dvec3 area = doubled_area(mesh, patch);
        EXPECT_GE(glm::dot(area, polygon), 0);
        triangles += area;
    }
    EXPECT_NEAR(glm::length(triangles) / glm::length(polygon), 1, 1e-9);
}

TEST(Bilinear, OpenArenaMap) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    Mesh mesh = shared_mesh("oa_map/oacmpdm1.obj");
    mesh.scheme = Scheme::bilinear;
    validate_mesh(mesh);
    const Topology t = analyse_topology(mesh);
    EXPECT_GE(t.patches.size(), mesh.face_sizes.size());
    EXPECT_EQ(t.max_exponent, max_exponent_limit);
    for (const PatchRecord& patch : t.patches) {
        for (int side = 0; side < 4; ++side) {
            ASSERT_LT(patch.side_curve[side], static_cast<int>(t.curves.size()));
        }
    }
}

} // namespace
} // namespace razor::test
