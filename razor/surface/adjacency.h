// Which faces and edges meet where in a cage, as flat arrays. A *corner* is one entry of Mesh::face_vertices;
// the edge that runs from it to the next corner of its face is its leading edge, the one that arrives at it
// its trailing edge.
#pragma once

#include "razor/scene/scene.h"

#include <array>
#include <span>
#include <vector>

namespace razor {

struct Adjacency {
    const std::vector<int>* face_vertices = nullptr; // Mesh::face_vertices, which must outlive this
    std::vector<int> face_first;                     // first corner of each face; one more entry at the end
    std::vector<int> corner_face;
    std::vector<int> corner_edge;                // the leading edge of each corner
    std::vector<std::array<int, 2>> edge_points; // lower, higher; ordered lexicographically
    std::vector<int> edge_first, edge_corners;   // corners whose leading edge is this one, ascending
    std::vector<int> point_first, point_corners; // corners at each point, ascending

    int face_count() const { return static_cast<int>(face_first.size()) - 1; }
    int edge_count() const { return static_cast<int>(edge_points.size()); }
    int point(int corner) const { return (*face_vertices)[static_cast<std::size_t>(corner)]; }
    int face(int corner) const { return corner_face[static_cast<std::size_t>(corner)]; }
    int first(int face) const { return face_first[static_cast<std::size_t>(face)]; }
    int size(int face) const { return face_first[static_cast<std::size_t>(face) + 1] - first(face); }
    int leading_edge(int corner) const { return corner_edge[static_cast<std::size_t>(corner)]; }
    int trailing_edge(int corner) const { return leading_edge(previous_corner(corner)); }
    int next_corner(int corner) const;
    int previous_corner(int corner) const;
    std::span<const int> corners_at_point(int point) const;
    std::span<const int> corners_at_edge(int edge) const;

    /// The corner at the same point in the neighbouring face, counter-clockwise (across the trailing edge) or
    /// clockwise (across the leading edge). -1 where the edge is a boundary, has more than two faces, or its
    /// two faces run the same way along it.
    int counter_clockwise(int corner) const;
    int clockwise(int corner) const;

    /// The edge between two points, or -1.
    int find_edge(int v0, int v1) const;
};

/// Indices of `mesh` must be in range and corners that follow each other distinct.
Adjacency build_adjacency(const Mesh& mesh);

/// Whether the faces at the point form one closed fan of exactly two.
bool is_interior_valence_two(const Adjacency& adjacency, int point);

} // namespace razor
