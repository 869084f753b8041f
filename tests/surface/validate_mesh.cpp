// Each mistake in a cage gives one line that names the mesh, the place and the mend.
#include "meshes.h"

#include "razor/scene/error.h"
#include "razor/surface/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace razor::test {
namespace {

std::string complaint(const Mesh& mesh) {
    try {
        validate_mesh(mesh);
        analyse_topology(mesh);
    } catch (const UserError& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos);
        EXPECT_TRUE(text.starts_with("mesh 'cage'")) << text;
        EXPECT_TRUE(text.find("; ") != std::string::npos) << text; // cause; mend
        return text;
    }
    return "";
}

void expect_complaint(const Mesh& mesh, const std::string& part) {
    const std::string text = complaint(mesh);
    EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

Mesh grid() {
    return quad_grid(4, 4);
}

TEST(ValidateMesh, AcceptsGoodMeshes) {
    for (const Mesh& mesh : hard_meshes()) {
        EXPECT_NO_THROW(validate_mesh(mesh)) << mesh.name;
    }
    Mesh isolated = grid();
    isolated.points.emplace_back(0, 0, 0);
    EXPECT_EQ(complaint(isolated), "");
}

TEST(ValidateMesh, Faces) {
    expect_complaint(cage(3, {}), "no face");
    expect_complaint(cage(3, {{0, 1, 2}, {0, 1}}), "face 1 (counted from 0) has 2 corners");
    expect_complaint(cage(3, {{0, 1, 3}}), "point 3 does not exist");
    expect_complaint(cage(3, {{0, 1, -1}}), "point -1 does not exist");
    expect_complaint(cage(4, {{0, 1, 900000, 2}}), "face 0 (counted from 0), corner 2");
    expect_complaint(cage(4, {{0, 1, 1, 2}}), "point 1 (counted from 0) twice in a row");
    expect_complaint(cage(4, {{0, 1, 2, 0}}), "point 0 (counted from 0) twice in a row");
    expect_complaint(cage(4, {{0, 1, 2, 1, 3}}), "point 1 (counted from 0) at two corners");
    EXPECT_EQ(complaint(cage(4, {{0, 1, 2, 1, 3}}, Scheme::bilinear)), "");
    expect_complaint(cage(4, {{0, 1, 0, 1}}, Scheme::bilinear), "2 distinct corners");
    Mesh short_list = grid();
    short_list.face_vertices.pop_back();
    expect_complaint(short_list, "add up to");
    Mesh negative = grid();
    negative.face_sizes[3] = -4;
    expect_complaint(negative, "face 3");
}

TEST(ValidateMesh, LargeFaces) {
    EXPECT_EQ(complaint(prism(256)), "");
    expect_complaint(prism(257), "at most 256");
    Mesh bilinear = prism(1025);
    bilinear.scheme = Scheme::bilinear;
    expect_complaint(bilinear, "at most 1024");
    expect_complaint(quad_pole(5000), "depends on more than 8192 points");
}

TEST(ValidateMesh, Points) {
    Mesh mesh = grid();
    mesh.points[5].y = std::numeric_limits<double>::quiet_NaN();
    expect_complaint(mesh, "point 5 (counted from 0)");
    mesh.points[5].y = std::numeric_limits<double>::infinity();
    expect_complaint(mesh, "not finite");
    mesh.points[5].y = 1.1e30;
    expect_complaint(mesh, "scale the mesh down");
}

TEST(ValidateMesh, TextureCoordinates) {
    Mesh mesh = grid();
    mesh.texcoords = {{0, 0}, {1, 0}};
    mesh.face_texcoords.assign(mesh.face_vertices.size(), 1);
    EXPECT_EQ(complaint(mesh), "");
    mesh.face_texcoords[6] = 2;
    expect_complaint(mesh, "face 1 (counted from 0), corner 2: texture coordinate 2");
    mesh.face_texcoords.pop_back();
    expect_complaint(mesh, "texture coordinate indices");
    mesh.face_texcoords.assign(mesh.face_vertices.size(), 1);
    mesh.texcoords[0].x = std::nanf("");
    expect_complaint(mesh, "texture coordinate 0");
}

TEST(ValidateMesh, MaterialsOfFaces) {
    Mesh mesh = grid();
    mesh.face_materials.assign(mesh.face_sizes.size(), 0);
    EXPECT_EQ(complaint(mesh), "");
    mesh.face_materials.pop_back();
    expect_complaint(mesh, "materials of 15 faces, but 16 faces");
}

TEST(ValidateMesh, Tags) {
    Mesh mesh = grid();
    mesh.corners = {{25, 1}};
    expect_complaint(mesh, "corner tag names point 25");
    mesh.corners = {{3, -1}};
    expect_complaint(mesh, "sharpness -1");
    mesh = grid();
    mesh.holes = {16};
    expect_complaint(mesh, "hole tag names face 16");
    mesh = grid();
    mesh.creases = {{0, 6, 1}};
    expect_complaint(mesh, "points 0 and 6 (counted from 0), which is not an edge");
    mesh.creases = {{0, -6, 1}};
    expect_complaint(mesh, "point -6");
    mesh.creases = {{0, 1, std::nanf("")}};
    expect_complaint(mesh, "sharpness");
    mesh = grid();
    mesh.edge_length = -1;
    expect_complaint(mesh, "edge length");
}

TEST(ValidateMesh, CreasesAtInteriorPointsOfTwoFaces) {
    Mesh mesh = cage(5, {{0, 1, 2, 3}, {2, 1, 0, 4}});
    EXPECT_EQ(complaint(mesh), "");
    mesh.creases = {{1, 0, 2}};
    expect_complaint(mesh, "a point of only two faces");
    mesh.creases = {{1, 0, 0}};
    EXPECT_EQ(complaint(mesh), "");
}

} // namespace
} // namespace razor::test
