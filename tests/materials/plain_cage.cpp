#include "tests/materials/plain_cage.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace razor::test {
namespace {

using glm::dvec3;

struct Polygons {
    std::vector<dvec3> points;
    std::vector<std::vector<int>> faces;
};

int number(std::size_t n) {
    return static_cast<int>(n);
}
std::size_t at(int n) {
    return static_cast<std::size_t>(n);
}

/// About each vertex: sums over its faces and edges, and how many these are.
struct Around {
    dvec3 middles{0}; // of its faces
    dvec3 ends{0};    // of its edges, the other ones
    dvec3 corners{0}; // of its faces, if they are quads, those across
    int valence = 0;
};
std::vector<Around> surroundings(const Polygons& p) {
    std::vector<Around> all(p.points.size());
    for (const std::vector<int>& face : p.faces) {
        dvec3 middle(0);
        for (const int v : face)
            middle += p.points[at(v)] / double(face.size());
        for (std::size_t k = 0; k < face.size(); ++k) {
            Around& a = all[at(face[k])];
            a.middles += middle;
            a.ends += p.points[at(face[(k + 1) % face.size()])]; // each edge leaves it in one face
            a.corners += p.points[at(face[(k + 2) % face.size()])];
            ++a.valence;
        }
    }
    return all;
}

/// Catmull & Clark, Recursively Generated B-Spline Surfaces on Arbitrary Topological Meshes (1978).
Polygons divided(const Polygons& cage) {
    Polygons fine;
    const std::vector<Around> around = surroundings(cage);
    for (std::size_t v = 0; v < around.size(); ++v) {
        const Around& a = around[v];
        const double n = a.valence;
        const dvec3 edges = (a.ends / n + cage.points[v]) / 2.0; // the mean of its edges' middles
        fine.points.push_back((a.middles / n + 2.0 * edges + (n - 3) * cage.points[v]) / n);
    }
    std::map<std::pair<int, int>, int> edge_points;
    const auto edge_point = [&](int a, int b) {
        const auto [found, added] =
            edge_points.try_emplace(std::pair(std::min(a, b), std::max(a, b)), number(fine.points.size()));
        if (added)
            fine.points.emplace_back((cage.points[at(a)] + cage.points[at(b)]) / 4.0);
        return found->second;
    };
    for (const std::vector<int>& face : cage.faces) {
        dvec3 middle(0);
        for (const int v : face)
            middle += cage.points[at(v)] / double(face.size());
        const int own = number(fine.points.size());
        fine.points.push_back(middle);
        for (std::size_t k = 0; k < face.size(); ++k) {
            const int here = face[k], next = face[(k + 1) % face.size()];
            const int before = face[(k + face.size() - 1) % face.size()];
            const int after = edge_point(here, next);
            fine.points[at(after)] += middle / 4.0; // once from each side
            fine.faces.push_back(std::vector<int>{here, after, own, edge_point(before, here)});
        }
    }
    return fine;
}

} // namespace

PlainQuads plain_limit(const Mesh& cage, int times) {
    Polygons p{cage.points, {}};
    std::size_t first = 0;
    for (const int size : cage.face_sizes) {
        const auto from = cage.face_vertices.begin() + static_cast<std::ptrdiff_t>(first);
        p.faces.emplace_back(from, from + size);
        first += at(size);
    }
    for (int k = 0; k < times; ++k)
        p = divided(p);
    PlainQuads quads;
    // Halstead, Kass & DeRose, Efficient, Fair Interpolation Using Catmull-Clark Surfaces (1993).
    const std::vector<Around> around = surroundings(p);
    for (std::size_t v = 0; v < around.size(); ++v) {
        const double n = around[v].valence;
        quads.points.push_back((n * n * p.points[v] + 4.0 * around[v].ends + around[v].corners) /
                               (n * (n + 5)));
    }
    quads.normals.resize(quads.points.size(), dvec3(0));
    for (const std::vector<int>& face : p.faces) {
        quads.faces.push_back({face[0], face[1], face[2], face[3]});
        const auto point = [&](int k) { return quads.points[at(face[at(k)])]; };
        const dvec3 area = glm::cross(point(2) - point(0), point(3) - point(1));
        for (const int v : face)
            quads.normals[at(v)] += area;
    }
    for (dvec3& n : quads.normals)
        n = glm::normalize(n);
    return quads;
}

} // namespace razor::test
