#include "meshes.h"

#include "razor/scene/error.h"
#include "razor/scene/models/obj_reader.h"
#include "razor/surface/topology.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace razor::test {

namespace fs = std::filesystem;

Mesh cage(int points, const std::vector<std::vector<int>>& faces, Scheme scheme) {
    std::mt19937 random(12345);
    const auto next = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    Mesh mesh;
    mesh.name = "cage";
    mesh.scheme = scheme;
    for (int i = 0; i < points; ++i) {
        const double x = next(), y = next(), z = next();
        mesh.points.emplace_back(x, y, z);
    }
    for (const std::vector<int>& face : faces) {
        mesh.face_sizes.push_back(static_cast<int>(face.size()));
        mesh.face_vertices.insert(mesh.face_vertices.end(), face.begin(), face.end());
    }
    return mesh;
}

Mesh quad_grid(int columns, int rows) {
    std::vector<std::vector<int>> faces;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int p = j * (columns + 1) + i;
            faces.push_back({p, p + 1, p + columns + 2, p + columns + 1});
        }
    }
    Mesh mesh = cage((columns + 1) * (rows + 1), faces);
    for (int p = 0; p < (columns + 1) * (rows + 1); ++p) {
        glm::dvec3& x = mesh.points[static_cast<std::size_t>(p)];
        x = glm::dvec3(p % (columns + 1), p / (columns + 1), 0) + 0.3 * x;
    }
    return mesh;
}

Mesh cube() {
    Mesh mesh = cage(8, {{0, 1, 3, 2}, {2, 3, 5, 4}, {4, 5, 7, 6}, {6, 7, 1, 0}, {1, 7, 5, 3}, {6, 0, 2, 4}});
    const double s = 0.5;
    mesh.points = {{-s, -s, s}, {s, -s, s}, {-s, s, s},   {s, s, s},
                   {-s, s, -s}, {s, s, -s}, {-s, -s, -s}, {s, -s, -s}};
    return mesh;
}

namespace {
glm::dvec3 on_circle(int i, int n, double radius, double height) {
    const double angle = 2 * std::numbers::pi * i / n;
    return {radius * std::cos(angle), radius * std::sin(angle), height};
}
} // namespace

Mesh quad_pole(int valence) {
    std::vector<std::vector<int>> faces;
    for (int i = 0; i < valence; ++i) {
        faces.push_back({0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % (2 * valence)});
    }
    Mesh mesh = cage(1 + 2 * valence, faces);
    mesh.points[0] = {0, 0, 0.5};
    for (int i = 0; i < 2 * valence; ++i) {
        mesh.points[static_cast<std::size_t>(1 + i)] =
            on_circle(i, 2 * valence, i % 2 == 0 ? 1 : 1.3, 0.1 * (i % 3));
    }
    return mesh;
}

Mesh triangle_pole(int valence) {
    std::vector<std::vector<int>> faces;
    for (int i = 0; i < valence; ++i) {
        const int a = 1 + i, b = 1 + (i + 1) % valence;
        faces.push_back({0, a, b});
        faces.push_back({a, a + valence, b + valence, b});
    }
    Mesh mesh = cage(1 + 2 * valence, faces);
    mesh.points[0] = {0, 0, 0.5};
    for (int i = 0; i < valence; ++i) {
        mesh.points[static_cast<std::size_t>(1 + i)] = on_circle(i, valence, 1, 0.1 * (i % 3));
        mesh.points[static_cast<std::size_t>(1 + valence + i)] = on_circle(i, valence, 1.5, -0.5);
    }
    return mesh;
}

Mesh prism(int sides) {
    std::vector<std::vector<int>> faces(2);
    for (int i = 0; i < sides; ++i) {
        const int j = (i + 1) % sides;
        faces[0].push_back(sides - 1 - i);
        faces[1].push_back(sides + i);
        faces.push_back({i, j, sides + j, sides + i});
    }
    Mesh mesh = cage(2 * sides, faces);
    for (int i = 0; i < sides; ++i) {
        mesh.points[static_cast<std::size_t>(i)] = on_circle(i, sides, 1, 0);
        mesh.points[static_cast<std::size_t>(sides + i)] = on_circle(i, sides, 0.8, 1 + 0.1 * (i % 2));
    }
    return mesh;
}

Mesh pillow(int sides) {
    std::vector<int> front, back;
    for (int i = 0; i < sides; ++i) {
        front.push_back(i);
        back.push_back(sides - 1 - i);
    }
    return cage(sides, {front, back});
}

namespace {
std::vector<std::vector<int>> torus(int round, int along, int first_point) {
    std::vector<std::vector<int>> faces;
    for (int i = 0; i < round; ++i) {
        for (int j = 0; j < along; ++j) {
            const int i1 = (i + 1) % round, j1 = (j + 1) % along;
            faces.push_back({first_point + i * along + j, first_point + i1 * along + j,
                             first_point + i1 * along + j1, first_point + i * along + j1});
        }
    }
    return faces;
}
} // namespace

bool have_shared_scenes() {
    return fs::is_directory(fs::path(RAZOR_SHARED_SCENES) / "osd");
}

Mesh shared_mesh(const std::string& path) {
    Mesh mesh = read_obj(fs::path(RAZOR_SHARED_SCENES) / path);
    if (mesh.name.starts_with("bilinear")) {
        mesh.scheme = Scheme::bilinear;
    }
    return mesh;
}

std::vector<Mesh> osd_meshes() {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(RAZOR_SHARED_SCENES) / "osd")) {
        if (entry.path().extension() == ".obj") {
            names.push_back("osd/" + entry.path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    std::vector<Mesh> meshes;
    for (const std::string& name : names) {
        try {
            Mesh mesh = shared_mesh(name);
            validate_mesh(mesh);
            analyse_topology(mesh);
            meshes.push_back(std::move(mesh));
        } catch (const UserError& error) {
            fmt::print("  not rendered: {}\n", error.what());
        }
    }
    return meshes;
}

std::vector<Mesh> hard_meshes() {
    std::vector<Mesh> meshes;
    const auto add = [&](const std::string& name, Mesh mesh) -> Mesh& {
        mesh.name = name;
        return meshes.emplace_back(std::move(mesh));
    };
    add("grid", quad_grid(5, 5));
    add("cube", cube());
    add("quad pole 65", quad_pole(65));
    add("triangle pole 64", triangle_pole(64));
    add("prism 7", prism(7));
    add("prism 65", prism(65));
    add("pillow 3", pillow(3));
    add("pillow 4", pillow(4));
    add("pillow 6", pillow(6));
    add("three faces at an edge", cage(8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}));
    add("faces that run the same way", cage(6, {{0, 1, 2, 3}, {0, 1, 4, 5}}));
    add("bow tie", cage(7, {{0, 1, 2, 3}, {0, 4, 5, 6}}));
    add("two cubes' corners",
        cage(13, {{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 5, 6, 1}, {0, 7, 8, 9}, {0, 9, 10, 11}, {0, 11, 12, 7}}));
    {
        Mesh& m = add("semi-sharp", quad_grid(6, 6));
        m.creases = {{16, 17, 0.7F},  {17, 18, 2.5F},  {18, 25, 4.0F},
                     {24, 31, 10.0F}, {31, 38, 10.0F}, {31, 32, 1.0F}};
        m.corners = {{33, 1.5F}, {30, 10.0F}};
    }
    {
        Mesh& m = add("chaikin", quad_grid(6, 6));
        m.crease_method = CreaseMethod::chaikin;
        m.creases = {{16, 17, 3.0F}, {17, 18, 1.5F}, {18, 25, 4.0F}, {25, 32, 2.0F}};
    }
    {
        Mesh& m = add("boundary none", quad_grid(5, 5));
        m.boundary = BoundaryInterpolation::none;
    }
    {
        Mesh& m = add("edge and corner with holes", quad_grid(5, 4));
        m.boundary = BoundaryInterpolation::edge_and_corner;
        m.holes = {7, 8};
    }
    {
        Mesh& m = add("smooth triangles", triangle_pole(9));
        m.triangles = TriangleSubdivision::smooth;
    }
    // A torus 3 faces round, where ring points coincide, beside one 6 faces round, where they do not.
    std::vector<std::vector<int>> tori = torus(3, 5, 0), thick = torus(6, 7, 15);
    tori.insert(tori.end(), thick.begin(), thick.end());
    add("two tori", cage(15 + 42, tori));
    add("two tagged tori", cage(15 + 42, tori)).corners = {{7, 2.0F}, {15 + 16, 2.0F}};
    return meshes;
}

double extent(const Mesh& mesh) {
    glm::dvec3 low = mesh.points[0], high = low;
    for (const glm::dvec3& p : mesh.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return glm::length(high - low);
}

} // namespace razor::test
