#include "razor/surface/bilinear_patches.h"

#include "razor/surface/ear_clipping.h"
#include "razor/surface/patches.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

/// No corner turns right (straight ones and ones without area are fine).
bool is_convex(std::span<const glm::dvec2> p) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (doubled_area(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0) {
            return false;
        }
    }
    return true;
}

void append_triangle(const Adjacency& adjacency, int face, int sub, const std::array<int, 3>& local,
                     Topology& topology) {
    const int first = adjacency.first(face);
    const std::array<int, 3> corner{first + local[0], first + local[1], first + local[2]};
    PatchRecord patch{};
    patch.kind = PatchKind::flat_triangle;
    patch.face = face;
    patch.sub = sub;
    for (int i = 0; i < 4; ++i) {
        patch.corner[i] = adjacency.point(corner[static_cast<std::size_t>(std::min(i, 2))]);
        patch.side_curve[i] = -1;
    }
    // Side 2 has no length. Side 3 runs from corner 0 to corner 2, against the polygon.
    constexpr std::array<std::array<int, 3>, 3> sides{
        {{0, 0, 1}, {1, 1, 2}, {3, 2, 0}}}; // side, from, to along the polygon
    for (const auto& [side, from, to] : sides) {
        const int edge_corner = corner[static_cast<std::size_t>(from)],
                  end = corner[static_cast<std::size_t>(to)];
        if (adjacency.next_corner(edge_corner) == end) {
            set_edge_side(adjacency, patch, side, edge_corner, side == 3 ? end : edge_corner);
        }
    }
    topology.patches.push_back(patch);
}

void append_face(const Mesh& mesh, const Adjacency& adjacency, int face, bool diced, Topology& topology) {
    const int first = adjacency.first(face), size = adjacency.size(face);
    const bool deforms = !mesh.rest.empty();
    const std::vector<glm::dvec3>& points = deforms ? mesh.rest : mesh.points;
    std::vector<glm::dvec3> polygon;
    for (int i = 0; i < size; ++i) {
        polygon.push_back(points[static_cast<std::size_t>(adjacency.point(first + i))]);
    }
    const std::vector<glm::dvec2> flat = project_if_planar(polygon);
    if (flat.empty() || (diced && is_convex(flat))) {
        if (size == 4) {
            append_quad(adjacency, face, PatchKind::bilinear, topology);
        } else {
            append_sub_faces(adjacency, face, PatchKind::bilinear, topology);
        }
    } else if (size == 4 && is_convex(flat)) {
        append_quad(adjacency, face, deforms ? PatchKind::bilinear : PatchKind::flat_quad, topology);
    } else {
        int sub = 0;
        for (const std::array<int, 3>& triangle : clip_ears(flat)) {
            append_triangle(adjacency, face, sub++, triangle, topology);
        }
    }
}

} // namespace

std::vector<glm::dvec2> project_if_planar(std::span<const glm::dvec3> polygon) {
    glm::dvec3 normal(0), low = polygon[0], high = polygon[0], mean(0);
    for (std::size_t i = 0; i < polygon.size(); ++i) { // Newell's normal, relative to the first corner
        const glm::dvec3 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
        normal += glm::cross(a, b);
        mean += a;
        low = glm::min(low, polygon[i]);
        high = glm::max(high, polygon[i]);
    }
    mean /= static_cast<double>(polygon.size());
    const double length = glm::length(normal);
    if (polygon.size() > 3 && length > 0) {
        const double allowed = planar_tolerance * glm::length(high - low) * length;
        for (const glm::dvec3& p : polygon) {
            if (std::abs(glm::dot(p - polygon[0] - mean, normal)) > allowed) {
                return {};
            }
        }
    }
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool turned = normal[axis] < 0;
    std::vector<glm::dvec2> flat;
    for (const glm::dvec3& p : polygon) {
        const glm::dvec3 d = p - polygon[0];
        flat.emplace_back(turned ? d[v] : d[u], turned ? d[u] : d[v]);
    }
    return flat;
}

void append_bilinear_patches(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                             bool diced, Topology& topology) {
    topology.controls = mesh.face_vertices;
    for (int f = 0; f < adjacency.face_count(); ++f) {
        FaceRecord& record = topology.faces[static_cast<std::size_t>(f)];
        record.control_first = adjacency.first(f);
        record.control_count = adjacency.size(f);
        if (drawn[static_cast<std::size_t>(f)]) {
            append_face(mesh, adjacency, f, diced, topology);
        }
    }
}

} // namespace razor
