#include "razor/surface/topology.h"

#include "razor/surface/adjacency.h"
#include "razor/surface/bilinear_patches.h"
#include "razor/surface/curves.h"
#include "razor/surface/face_classes.h"
#include "razor/surface/page_layout.h"
#include "razor/surface/patches.h"
#include "razor/surface/refiner.h"

#include <algorithm>

namespace razor {

bool same_topology(const Mesh& a, const Mesh& b, double factor) {
    const auto alike = [factor](const std::vector<glm::dvec3>& x, const std::vector<glm::dvec3>& y) {
        return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                          [factor](const glm::dvec3& p, const glm::dvec3& q) { return p * factor == q; });
    };
    const bool cuts = a.scheme == Scheme::bilinear; // by points
    return a.scheme == b.scheme && a.points.size() == b.points.size() && a.face_sizes == b.face_sizes &&
           a.face_vertices == b.face_vertices && a.creases == b.creases && a.corners == b.corners &&
           a.holes == b.holes && a.boundary == b.boundary && a.crease_method == b.crease_method &&
           a.triangles == b.triangles && a.face_texcoords == b.face_texcoords && a.texcoords == b.texcoords &&
           a.face_varying == b.face_varying &&
           (!cuts || (alike(a.rest, b.rest) && (!a.rest.empty() || alike(a.points, b.points))));
}

Topology analyse_topology(const Mesh& mesh, Cut cut) {
    const bool displaced = cut == Cut::displaced;
    const Adjacency adjacency = build_adjacency(mesh);
    const std::vector<bool> drawn = faces_with_limit_surface(mesh);
    Topology topology;
    topology.displaced = displaced;
    topology.undrawn_faces = static_cast<int>(std::count(drawn.begin(), drawn.end(), false));
    for (const int size : mesh.face_sizes) {
        topology.faces.push_back({-1, 0, 0, size, 0});
    }
    build_edge_curves(adjacency, drawn, topology);
    if (mesh.scheme == Scheme::bilinear && !displaced) {
        append_bilinear_patches(mesh, adjacency, drawn, cut == Cut::diced, topology);
        return topology;
    }
    if (mesh.scheme == Scheme::bilinear) {
        assign_straight_classes(mesh, adjacency, drawn, topology);
    } else {
        assign_face_classes(mesh, adjacency, drawn, topology);
    }
    for (int f = 0; f < adjacency.face_count(); ++f) {
        if (!drawn[static_cast<std::size_t>(f)]) {
            continue;
        }
        if (adjacency.size(f) == 4) {
            append_quad(adjacency, f, PatchKind::catmull_clark, topology);
        } else {
            append_sub_faces(adjacency, f, PatchKind::catmull_clark, topology);
        }
    }
    topology.max_exponent = largest_exponent(mesh, topology.classes);
    return topology;
}

} // namespace razor
