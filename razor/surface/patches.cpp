#include "razor/surface/patches.h"

#include "razor/surface/curves.h"

namespace razor {

void set_edge_side(const Adjacency& adjacency, PatchRecord& patch, int side, int edge_corner, int from) {
    const int edge = adjacency.leading_edge(edge_corner);
    patch.side_curve[side] = edge;
    const bool reversed = adjacency.point(from) != adjacency.edge_points[static_cast<std::size_t>(edge)][0];
    patch.side_flags[side] = reversed ? side_reversed : 0;
}

void append_quad(const Adjacency& adjacency, int face, PatchKind kind, Topology& topology) {
    const int c = adjacency.first(face);
    PatchRecord patch{};
    patch.kind = kind;
    patch.face = face;
    for (int i = 0; i < 4; ++i) {
        patch.corner[i] = adjacency.point(c + i);
    }
    set_edge_side(adjacency, patch, 0, c, c);
    set_edge_side(adjacency, patch, 1, c + 1, c + 1);
    set_edge_side(adjacency, patch, 2, c + 2, c + 3);
    set_edge_side(adjacency, patch, 3, c + 3, c);
    topology.patches.push_back(patch);
}

void append_sub_faces(const Adjacency& adjacency, int face, PatchKind kind, Topology& topology) {
    const int first_spoke = append_spokes(adjacency, face, topology);
    const int first = adjacency.first(face), size = adjacency.size(face);
    for (int i = 0; i < size; ++i) {
        const int corner = first + i;
        const int before = adjacency.previous_corner(corner);
        PatchRecord patch{};
        patch.kind = kind;
        patch.face = face;
        patch.sub = i;
        set_edge_side(adjacency, patch, 0, corner, corner);
        set_edge_side(adjacency, patch, 3, before, corner);
        patch.side_flags[0] |= side_half;
        patch.side_flags[3] |= side_half;
        patch.side_curve[1] = first_spoke + i;
        patch.side_curve[2] = first_spoke + before - first;
        patch.corner[0] = adjacency.point(corner);
        patch.corner[1] = adjacency.leading_edge(corner);
        patch.corner[2] = face;
        patch.corner[3] = adjacency.leading_edge(before);
        topology.patches.push_back(patch);
    }
}

} // namespace razor
