#include "razor/surface/adjacency.h"

#include <algorithm>
#include <numeric>

namespace razor {
namespace {

std::span<const int> slice(const std::vector<int>& first, const std::vector<int>& all, int index) {
    const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(index)]);
    const auto end = static_cast<std::size_t>(first[static_cast<std::size_t>(index) + 1]);
    return std::span(all).subspan(begin, end - begin);
}

/// Lists the positions of each value of `keys` (in [0, key_count)), ascending.
void group(const std::vector<int>& keys, std::size_t key_count, std::vector<int>& first,
           std::vector<int>& members) {
    first.assign(key_count + 1, 0);
    for (const int key : keys) {
        ++first[static_cast<std::size_t>(key) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    members.resize(keys.size());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        members[static_cast<std::size_t>(next[static_cast<std::size_t>(keys[i])]++)] = static_cast<int>(i);
    }
}

} // namespace

int Adjacency::next_corner(int corner) const {
    const int f = face(corner);
    return corner + 1 == first(f) + size(f) ? first(f) : corner + 1;
}

int Adjacency::previous_corner(int corner) const {
    const int f = face(corner);
    return corner == first(f) ? first(f) + size(f) - 1 : corner - 1;
}

std::span<const int> Adjacency::corners_at_point(int p) const {
    return slice(point_first, point_corners, p);
}

std::span<const int> Adjacency::corners_at_edge(int edge) const {
    return slice(edge_first, edge_corners, edge);
}

int Adjacency::counter_clockwise(int corner) const {
    const int arriving = previous_corner(corner);
    const std::span<const int> sides = corners_at_edge(leading_edge(arriving));
    if (sides.size() != 2) {
        return -1;
    }
    const int other = sides[0] == arriving ? sides[1] : sides[0];
    return point(other) == point(corner) ? other : -1;
}

int Adjacency::clockwise(int corner) const {
    const std::span<const int> sides = corners_at_edge(leading_edge(corner));
    if (sides.size() != 2) {
        return -1;
    }
    const int other = sides[0] == corner ? sides[1] : sides[0];
    return point(other) == point(corner) ? -1 : next_corner(other);
}

int Adjacency::find_edge(int v0, int v1) const {
    const std::array<int, 2> key{std::min(v0, v1), std::max(v0, v1)};
    const auto found = std::lower_bound(edge_points.begin(), edge_points.end(), key);
    return found != edge_points.end() && *found == key ? static_cast<int>(found - edge_points.begin()) : -1;
}

Adjacency build_adjacency(const Mesh& mesh) {
    Adjacency a;
    a.face_vertices = &mesh.face_vertices;
    a.face_first.reserve(mesh.face_sizes.size() + 1);
    a.face_first.push_back(0);
    a.corner_face.reserve(mesh.face_vertices.size());
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        a.corner_face.insert(a.corner_face.end(), static_cast<std::size_t>(mesh.face_sizes[f]),
                             static_cast<int>(f));
        a.face_first.push_back(a.face_first.back() + mesh.face_sizes[f]);
    }
    struct Keyed {
        std::array<int, 2> points;
        int corner;
    };
    std::vector<Keyed> sides;
    sides.reserve(mesh.face_vertices.size());
    for (int c = 0; c < static_cast<int>(mesh.face_vertices.size()); ++c) {
        const auto [low, high] = std::minmax({a.point(c), a.point(a.next_corner(c))});
        sides.push_back({{low, high}, c});
    }
    std::sort(sides.begin(), sides.end(), [](const Keyed& x, const Keyed& y) {
        return x.points != y.points ? x.points < y.points : x.corner < y.corner;
    });
    a.corner_edge.resize(sides.size());
    for (const Keyed& side : sides) {
        if (a.edge_points.empty() || a.edge_points.back() != side.points) {
            a.edge_points.push_back(side.points);
        }
        a.corner_edge[static_cast<std::size_t>(side.corner)] = a.edge_count() - 1;
    }
    group(a.corner_edge, a.edge_points.size(), a.edge_first, a.edge_corners);
    group(mesh.face_vertices, mesh.points.size(), a.point_first, a.point_corners);
    return a;
}

bool is_interior_valence_two(const Adjacency& a, int point) {
    const std::span<const int> corners = a.corners_at_point(point);
    return corners.size() == 2 && a.counter_clockwise(corners[0]) == corners[1] &&
           a.counter_clockwise(corners[1]) == corners[0];
}

} // namespace razor
