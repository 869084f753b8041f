#include "razor/scene/models/md3_cage.h"

#include "razor/scene/models/hard_edges.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <utility>

namespace razor {
namespace {

constexpr double units_a_step = 1.0 / 64;

/// Of a number that is not negative.
std::size_t as_size(int number) {
    return static_cast<std::size_t>(number);
}

/// Of each vertex, one that stands for all with the same.
struct Groups {
    std::vector<int> point;    // the same point in every frame
    std::vector<int> texcoord; // moreover the same texture coordinate
};

/// Sorting brings equal vertices side by side.
Groups group_vertices(const Md3Triangles& triangles) {
    const std::size_t stride = 3 * triangles.frame_count;
    const auto compare_points = [&](int a, int b) {
        const std::int16_t* const steps = triangles.steps.data();
        return std::memcmp(steps + stride * as_size(a), steps + stride * as_size(b),
                           stride * sizeof(std::int16_t));
    };
    const auto texcoord = [&](int v) {
        const glm::vec2 t = triangles.texcoords[as_size(v)];
        return std::pair(t.x, t.y);
    };
    std::vector<int> order(triangles.texcoords.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const int compared = compare_points(a, b);
        return compared != 0 ? compared < 0 : texcoord(a) < texcoord(b);
    });
    Groups groups{std::vector<int>(order.size()), std::vector<int>(order.size())};
    for (std::size_t i = 0; i < order.size(); ++i) {
        const int v = order[i], before = order[i == 0 ? 0 : i - 1];
        const bool same_point = i > 0 && compare_points(before, v) == 0;
        const bool same_texcoord = same_point && texcoord(before) == texcoord(v);
        groups.point[as_size(v)] = same_point ? groups.point[as_size(before)] : v;
        groups.texcoord[as_size(v)] = same_texcoord ? groups.texcoord[as_size(before)] : v;
    }
    return groups;
}

/// Turns the vertices that stand for groups in `corners` into numbers from 0, in the order of the file and
/// only of groups that are named. The first vertex of each numbered group. `group_of` has the group of each
/// vertex.
std::vector<int> number_groups(std::vector<int>& corners, const std::vector<int>& group_of) {
    constexpr int unnamed = -2, unnumbered = -1;
    std::vector<int> numbers(group_of.size(), unnamed);
    for (const int group : corners) {
        numbers[as_size(group)] = unnumbered;
    }
    std::vector<int> first;
    for (std::size_t v = 0; v < group_of.size(); ++v) {
        if (int& number = numbers[as_size(group_of[v])]; number == unnumbered) {
            number = static_cast<int>(first.size());
            first.push_back(static_cast<int>(v));
        }
    }
    for (int& corner : corners) {
        corner = numbers[as_size(corner)];
    }
    return first;
}

/// Adds faces of the triangles whose corners stay distinct, with groups as their points. The normals of their
/// corners, if there are any.
std::vector<glm::vec3> add_faces(const Md3Triangles& triangles, const Groups& groups, Md3Model& model) {
    Mesh& cage = model.cage;
    const std::vector<int>& corners = triangles.corners;
    std::vector<glm::vec3> normals;
    for (std::size_t c = 0; c < corners.size(); c += 3) {
        std::array<int, 3> points{};
        for (std::size_t i = 0; i < 3; ++i) {
            points[i] = groups.point[as_size(corners[c + i])];
        }
        if (points[0] == points[1] || points[1] == points[2] || points[2] == points[0]) {
            continue;
        }
        cage.face_sizes.push_back(3);
        model.face_surfaces.push_back(triangles.surfaces[c / 3]);
        for (std::size_t i = 0; i < 3; ++i) {
            cage.face_vertices.push_back(points[i]);
            cage.face_texcoords.push_back(groups.texcoord[as_size(corners[c + i])]);
            if (!triangles.normals.empty()) {
                normals.push_back(triangles.normals[as_size(corners[c + i])]);
            }
        }
    }
    return normals;
}

} // namespace

Md3Model join(const Md3Triangles& triangles, double crease_degrees) {
    const Groups groups = group_vertices(triangles);
    Md3Model model;
    Mesh& cage = model.cage;
    const std::vector<glm::vec3> normals = add_faces(triangles, groups, model);
    if (cage.face_sizes.empty()) {
        return model;
    }
    for (const int v : number_groups(cage.face_texcoords, groups.texcoord)) {
        cage.texcoords.push_back(triangles.texcoords[as_size(v)]);
    }
    const std::vector<int> vertices = number_groups(cage.face_vertices, groups.point);
    cage.creases = hard_edges(cage.face_vertices, normals, crease_degrees);
    model.frames.resize(triangles.frame_count);
    for (std::size_t f = 0; f < triangles.frame_count; ++f) {
        model.frames[f].reserve(vertices.size());
        for (const int v : vertices) {
            const std::int16_t* const p = &triangles.steps[3 * (as_size(v) * triangles.frame_count + f)];
            model.frames[f].push_back(units_a_step * glm::dvec3(p[0], p[1], p[2]));
        }
    }
    cage.points = model.frames.front();
    return model;
}

} // namespace razor
