#include "tests/reference/cages.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace razor::reference {

namespace {

void add_face(Mesh& mesh, const std::vector<int>& corners) {
    mesh.face_sizes.push_back(static_cast<int>(corners.size()));
    mesh.face_vertices.insert(mesh.face_vertices.end(), corners.begin(), corners.end());
}

/// The surface of a cube, n x n quads a side.
Mesh cube(int n) {
    Mesh mesh;
    std::map<std::array<int, 3>, int> numbers;
    auto number = [&](std::array<int, 3> at) {
        auto [entry, is_new] = numbers.try_emplace(at, static_cast<int>(mesh.points.size()));
        if (is_new)
            mesh.points.push_back(glm::dvec3(at[0], at[1], at[2]) * (2.0 / n) - 1.0);
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (int end = 0; end <= n; end += n)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    std::vector<int> corners;
                    for (auto [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                        std::array<int, 3> at{};
                        at[axis] = end;
                        at[(axis + 1) % 3] = i + di;
                        at[(axis + 2) % 3] = j + dj;
                        corners.push_back(number(at));
                    }
                    if (end == 0)
                        std::reverse(corners.begin(), corners.end());
                    add_face(mesh, corners);
                }
    return mesh;
}

/// Radii 1 and 0.4, about the y axis.
Mesh torus(int rings, int sides) {
    Mesh mesh;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            double a = 2 * std::numbers::pi * i / rings;
            double b = 2 * std::numbers::pi * j / sides;
            double r = 1 + 0.4 * std::cos(b);
            mesh.points.emplace_back(r * std::cos(a), 0.4 * std::sin(b), r * std::sin(a));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            int next_i = (i + 1) % rings;
            int next_j = (j + 1) % sides;
            add_face(mesh, {i * sides + j, i * sides + next_j, next_i * sides + next_j, next_i * sides + j});
        }
    return mesh;
}

/// Pentagons below and above, quads between.
Mesh prism() {
    Mesh mesh;
    constexpr int sides = 5;
    for (int i = 0; i < 2 * sides; ++i) {
        double a = 2 * std::numbers::pi * (i % sides) / sides;
        mesh.points.emplace_back(std::cos(a), i < sides ? -0.8 : 0.8, std::sin(a));
    }
    add_face(mesh, {0, 1, 2, 3, 4});
    add_face(mesh, {9, 8, 7, 6, 5});
    for (int i = 0; i < sides; ++i) {
        int next = (i + 1) % sides;
        add_face(mesh, {i, i + sides, next + sides, next});
    }
    return mesh;
}

double bumps(const glm::dvec3& d) {
    return 0.12 * std::sin(5 * d.x + 1) * std::sin(4 * d.y + 2) + 0.05 * std::sin(11 * d.z - 7 * d.x);
}

glm::dvec3 on_ball(glm::dvec3 p) {
    return glm::normalize(p);
}
glm::dvec3 on_bumpy_sphere(glm::dvec3 p) {
    glm::dvec3 d = glm::normalize(p);
    return d * (1 + bumps(d));
}
/// The ring about which the tube of the torus runs, at its place nearest to p.
glm::dvec3 ring(glm::dvec3 p) {
    return glm::normalize(glm::dvec3(p.x, 0, p.z));
}
glm::dvec3 on_bumpy_torus(glm::dvec3 p) {
    glm::dvec3 c = ring(p);
    return c + 0.4 * (1 + bumps(2.0 * p)) * glm::normalize(p - c);
}

PointMaker near_centre(double radius) {
    return [=](std::mt19937& random) { return radius * uniform(random) * random_direction(random); };
}
PointMaker near_ring(double radius) {
    return [=](std::mt19937& random) {
        return ring(random_direction(random)) + radius * uniform(random) * random_direction(random);
    };
}

} // namespace

double uniform(std::mt19937& random) {
    return static_cast<double>(random()) * 0x1p-32;
}

glm::dvec3 random_direction(std::mt19937& random) {
    for (;;) {
        glm::dvec3 d(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
        double square = glm::dot(d, d);
        if (square <= 1 && square > 0.01)
            return d / std::sqrt(square);
    }
}

const std::vector<std::string>& case_names() {
    static const std::vector<std::string> names{"sphere", "torus", "ball", "prism", "relief", "limit"};
    return names;
}

Case make_case(const std::string& name) {
    if (name == "sphere")
        return {name, cube(2), on_bumpy_sphere, false, 0, near_centre(0.3)};
    if (name == "torus")
        return {name, torus(8, 5), on_bumpy_torus, false, 0, near_ring(0.08)};
    if (name == "ball")
        return {name, cube(2), on_ball, false, 0, near_centre(0.3), true};
    if (name == "prism")
        return {name, prism(), on_ball, false, 0, near_centre(0.2), true};
    if (name == "relief")
        return {name, cube(2), on_bumpy_sphere, false, 0.04, near_centre(0.3)};
    if (name == "limit")
        return {name, torus(8, 5), {}, true, 0, near_ring(0.03)};
    throw std::invalid_argument("no case is called " + name);
}

} // namespace razor::reference
