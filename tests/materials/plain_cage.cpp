#include "tests/materials/plain_cage.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace razor::test {
namespace {

using glm::dvec2, glm::dvec3;
using Edge = std::pair<int, int>; // the lower number first

struct Polygon {
    std::vector<int> corners;
    std::vector<dvec2> texcoords; // of each
};

struct Polygons {
    std::vector<dvec3> points;
    std::vector<Polygon> faces;
    std::map<Edge, double> sharpness; // above 0
};

int number(std::size_t n) {
    return static_cast<int>(n);
}
std::size_t at(int n) {
    return static_cast<std::size_t>(n);
}

Edge edge(int a, int b) {
    return {std::min(a, b), std::max(a, b)};
}
double sharpness_of(const Polygons& p, int a, int b) {
    const auto found = p.sharpness.find(edge(a, b));
    return found == p.sharpness.end() ? 0 : found->second;
}
double less_sharp(double sharpness) {
    return sharpness >= infinite_sharpness ? sharpness : std::max(sharpness - 1, 0.0);
}

template <class Value> Value mean(const std::vector<Value>& values) {
    return std::accumulate(values.begin(), values.end(), Value(0)) / double(values.size());
}

/// About each vertex: sums over its faces and edges, and how many these are.
struct Around {
    dvec3 middles{0}; // of its faces
    dvec3 ends{0};    // of its edges, the other ones
    dvec3 corners{0}; // of its faces, if they are quads, those across
    int valence = 0;
    std::vector<std::pair<dvec3, double>> sharp; // of edges that are: the other end, and how much

    /// What is left of it after so many divisions.
    std::vector<dvec3> sharp_after(int times) const {
        std::vector<dvec3> ends_of;
        for (auto [end, sharpness] : sharp) {
            for (int k = 0; k < times; ++k)
                sharpness = less_sharp(sharpness);
            if (sharpness > 0)
                ends_of.push_back(end);
        }
        return ends_of;
    }
};
std::vector<Around> surroundings(const Polygons& p) {
    std::vector<Around> all(p.points.size());
    for (const auto& [face, texcoords] : p.faces) {
        dvec3 middle(0);
        for (const int v : face)
            middle += p.points[at(v)] / double(face.size());
        for (std::size_t k = 0; k < face.size(); ++k) {
            Around& a = all[at(face[k])];
            const int next = face[(k + 1) % face.size()]; // each edge leaves it in one face
            a.middles += middle;
            a.ends += p.points[at(next)];
            a.corners += p.points[at(face[(k + 2) % face.size()])];
            ++a.valence;
            if (const double sharpness = sharpness_of(p, face[k], next); sharpness > 0)
                a.sharp.emplace_back(p.points[at(next)], sharpness);
        }
    }
    return all;
}

/// Catmull & Clark, Recursively Generated B-Spline Surfaces on Arbitrary Topological Meshes (1978); on
/// creases cubic B-splines, and corners stay.
dvec3 moved_by(const Around& a, const dvec3& point, const std::vector<dvec3>& sharp) {
    if (sharp.size() > 2)
        return point;
    if (sharp.size() == 2)
        return (6.0 * point + sharp[0] + sharp[1]) / 8.0;
    const double n = a.valence;
    const dvec3 edges = (a.ends / n + point) / 2.0; // the mean of its edges' middles
    return (a.middles / n + 2.0 * edges + (n - 3) * point) / n;
}

/// Where creases end with this division, what is between both rules.
dvec3 moved(const Around& a, const dvec3& point) {
    double ending = 0;
    int count = 0;
    for (const auto& [end, sharpness] : a.sharp)
        if (less_sharp(sharpness) == 0) {
            ending += sharpness;
            ++count;
        }
    const dvec3 now = moved_by(a, point, a.sharp_after(0));
    return count == 0 ? now : glm::mix(moved_by(a, point, a.sharp_after(1)), now, ending / count);
}

class Division {
public:
    explicit Division(const Polygons& cage) : cage_(cage) {
        const std::vector<Around> around = surroundings(cage);
        for (std::size_t v = 0; v < around.size(); ++v)
            fine_.points.push_back(moved(around[v], cage.points[v]));
        std::vector<dvec3> middles;
        for (const Polygon& face : cage.faces) {
            std::vector<dvec3> points;
            for (const int v : face.corners)
                points.push_back(cage.points[at(v)]);
            middles.push_back(mean(points));
            for (std::size_t k = 0; k < face.corners.size(); ++k)
                beside_[edge(face.corners[k], next(face, k))].push_back(middles.back());
        }
        for (std::size_t f = 0; f < cage.faces.size(); ++f)
            divide(cage.faces[f], middles[f]);
    }
    Polygons result() && { return std::move(fine_); }

private:
    static int next(const Polygon& face, std::size_t k) {
        return face.corners[(k + 1) % face.corners.size()];
    }
    int edge_point(int a, int b) {
        const auto [found, added] = numbers_.try_emplace(edge(a, b), number(fine_.points.size()));
        if (!added)
            return found->second;
        const dvec3 straight = (cage_.points[at(a)] + cage_.points[at(b)]) / 2.0;
        const double sharpness = sharpness_of(cage_, a, b);
        fine_.points.push_back(
            glm::mix((straight + mean(beside_.at(edge(a, b)))) / 2.0, straight, std::min(sharpness, 1.0)));
        if (less_sharp(sharpness) > 0)
            for (const int end : {a, b})
                fine_.sharpness[edge(end, found->second)] = less_sharp(sharpness);
        return found->second;
    }
    void divide(const Polygon& face, const dvec3& middle) {
        const int own = number(fine_.points.size());
        fine_.points.push_back(middle);
        const std::size_t corners = face.corners.size();
        const dvec2 own_texcoord = mean(face.texcoords);
        for (std::size_t k = 0; k < corners; ++k) {
            const std::size_t after = (k + 1) % corners, before = (k + corners - 1) % corners;
            const auto half = [&](std::size_t to) { return (face.texcoords[k] + face.texcoords[to]) / 2.0; };
            fine_.faces.push_back({{face.corners[k], edge_point(face.corners[k], face.corners[after]), own,
                                    edge_point(face.corners[before], face.corners[k])},
                                   {face.texcoords[k], half(after), own_texcoord, half(before)}});
        }
    }

    const Polygons& cage_;
    Polygons fine_;
    std::map<Edge, std::vector<dvec3>> beside_; // middles of its faces
    std::map<Edge, int> numbers_;               // of edges' points
};

/// Halstead, Kass & DeRose, Efficient, Fair Interpolation Using Catmull-Clark Surfaces (1993); on creases
/// that of cubic B-splines.
dvec3 limit(const Around& a, const dvec3& point) {
    const std::vector<dvec3> sharp = a.sharp_after(0);
    if (sharp.size() > 2)
        return point;
    if (sharp.size() == 2)
        return (4.0 * point + sharp[0] + sharp[1]) / 6.0;
    const double n = a.valence;
    return (n * n * point + 4.0 * a.ends + a.corners) / (n * (n + 5));
}

/// Of corners of faces: sets about a vertex that no sharp edge parts.
class Sides {
public:
    explicit Sides(const Polygons& p) : above_(4 * p.faces.size()) {
        std::iota(above_.begin(), above_.end(), std::size_t{0});
        std::map<Edge, std::size_t> leaves; // the edge to the second from the first: the first's corner
        for (std::size_t c = 0; c < above_.size(); ++c)
            leaves[{vertex(p, c), vertex(p, beside(c, 1))}] = c;
        for (std::size_t c = 0; c < above_.size(); ++c) {
            const int here = vertex(p, c), before = vertex(p, beside(c, 3));
            if (sharpness_of(p, before, here) == 0)
                above_[top(c)] = top(leaves.at({here, before}));
        }
    }
    std::size_t top(std::size_t c) const {
        while (above_[c] != c)
            c = above_[c];
        return c;
    }

private:
    static std::size_t beside(std::size_t c, std::size_t step) { return c / 4 * 4 + (c + step) % 4; }
    static int vertex(const Polygons& p, std::size_t c) { return p.faces[c / 4].corners[c % 4]; }

    std::vector<std::size_t> above_;
};

Polygons cage_of(const Mesh& mesh) {
    Polygons p{mesh.points, {}, {}};
    std::size_t first = 0;
    for (const int size : mesh.face_sizes) {
        const auto from = mesh.face_vertices.begin() + static_cast<std::ptrdiff_t>(first);
        Polygon face{{from, from + size}, std::vector<dvec2>(at(size), dvec2(0))};
        for (std::size_t k = 0; k < at(size) && !mesh.face_texcoords.empty(); ++k)
            face.texcoords[k] = mesh.texcoords[at(mesh.face_texcoords[first + k])];
        p.faces.push_back(std::move(face));
        first += at(size);
    }
    for (const Crease& crease : mesh.creases)
        p.sharpness[edge(crease.v0, crease.v1)] = crease.sharpness;
    return p;
}

} // namespace

PlainQuads plain_limit(const Mesh& cage, int times) {
    Polygons p = cage_of(cage);
    for (int k = 0; k < times; ++k)
        p = Division(p).result();
    PlainQuads quads;
    const std::vector<Around> around = surroundings(p);
    for (std::size_t v = 0; v < around.size(); ++v)
        quads.points.push_back(limit(around[v], p.points[v]));
    std::vector<dvec3> areas(4 * p.faces.size(), dvec3(0)); // of each side, where it begins
    const Sides sides(p);
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        const std::vector<int>& face = p.faces[f].corners;
        const std::vector<dvec2>& texcoords = p.faces[f].texcoords;
        quads.faces.push_back({face[0], face[1], face[2], face[3]});
        quads.texcoords.push_back({texcoords[0], texcoords[1], texcoords[2], texcoords[3]});
        const auto point = [&](std::size_t k) { return quads.points[at(face[k])]; };
        const dvec3 area = glm::cross(point(2) - point(0), point(3) - point(1));
        for (std::size_t k = 0; k < 4; ++k)
            areas[sides.top(4 * f + k)] += area;
    }
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        auto& normals = quads.normals.emplace_back();
        for (std::size_t k = 0; k < 4; ++k)
            normals[k] = glm::normalize(areas[sides.top(4 * f + k)]);
    }
    return quads;
}

} // namespace razor::test
