#include "razor/surface/curves.h"

#include <algorithm>

namespace razor {
namespace {

/// The lowest corner in `corners` (ascending) that belongs to a drawn face, or -1.
int owning_corner(const Adjacency& adjacency, const std::vector<bool>& drawn, std::span<const int> corners) {
    const auto found = std::find_if(corners.begin(), corners.end(), [&](int c) {
        return drawn[static_cast<std::size_t>(adjacency.face(c))];
    });
    return found == corners.end() ? -1 : *found;
}

int local_index(const Adjacency& adjacency, int corner) {
    return corner - adjacency.first(adjacency.face(corner));
}

} // namespace

void build_edge_curves(const Adjacency& adjacency, const std::vector<bool>& drawn, Topology& topology) {
    topology.face_curves = adjacency.corner_edge;
    for (int f = 0; f < adjacency.face_count(); ++f) {
        topology.faces[static_cast<std::size_t>(f)].curve_first = adjacency.first(f);
    }
    topology.curves.reserve(adjacency.edge_points.size());
    for (int e = 0; e < adjacency.edge_count(); ++e) {
        const auto [low, high] = adjacency.edge_points[static_cast<std::size_t>(e)];
        CurveRecord curve{-1, 0, 0, low, high};
        if (const int c = owning_corner(adjacency, drawn, adjacency.corners_at_edge(e)); c >= 0) {
            curve.owner_face = adjacency.face(c);
            curve.owner_local = local_index(adjacency, c);
            curve.flags = adjacency.point(c) == high ? curve_owner_reversed : 0;
        }
        topology.curves.push_back(curve);
    }
    const auto point_count = static_cast<int>(adjacency.point_first.size()) - 1;
    topology.points.reserve(static_cast<std::size_t>(point_count));
    for (int p = 0; p < point_count; ++p) {
        const int c = owning_corner(adjacency, drawn, adjacency.corners_at_point(p));
        topology.points.push_back(c < 0 ? VertexRecord{-1, 0}
                                        : VertexRecord{adjacency.face(c), local_index(adjacency, c)});
    }
}

int append_spokes(const Adjacency& adjacency, int face, Topology& topology) {
    const auto first = static_cast<int>(topology.curves.size());
    const int size = adjacency.size(face);
    for (int i = 0; i < size; ++i) {
        topology.curves.push_back(
            {face, size + i, curve_spoke, adjacency.leading_edge(adjacency.first(face) + i), face});
    }
    return first;
}

} // namespace razor
