#include "razor/surface/texture_cage.h"

#include "razor/surface/adjacency.h"
#include "razor/surface/face_classes.h"
#include "razor/surface/page_layout.h"
#include "razor/surface/refiner.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace razor {
namespace {

/// Of a cage's point: the point of the mesh, and its texture coordinate there.
using Value = std::pair<int, int>;

/// What a point of the cage is on its boundary.
struct Rim {
    bool is_corner = false;   // of one face only
    bool is_boundary = false; // some edge there has one face
};

Rim rim_of(const Adjacency& adjacency, int point) {
    Rim rim;
    const std::span<const int> corners = adjacency.corners_at_point(point);
    rim.is_corner = corners.size() == 1;
    for (const int corner : corners)
        for (const int edge : {adjacency.leading_edge(corner), adjacency.trailing_edge(corner)})
            rim.is_boundary = rim.is_boundary || adjacency.corners_at_edge(edge).size() == 1;
    return rim;
}

/// Points that are sharp by the rule, all infinitely so.
void sharpen_seams(const Mesh& mesh, const std::vector<Value>& values, Mesh& cage) {
    if (mesh.face_varying == FaceVaryingInterpolation::none)
        return;
    const Adjacency adjacency = build_adjacency(cage);
    const Adjacency own = build_adjacency(mesh);
    std::vector<Rim> rims;
    std::map<int, std::vector<int>> at_point; // of the mesh
    for (std::size_t v = 0; v < values.size(); ++v) {
        rims.push_back(rim_of(adjacency, static_cast<int>(v)));
        at_point[values[v].first].push_back(static_cast<int>(v));
    }
    const bool three_regions = mesh.face_varying == FaceVaryingInterpolation::corners_plus1 ||
                               mesh.face_varying == FaceVaryingInterpolation::corners_plus2;
    const bool concave = mesh.face_varying == FaceVaryingInterpolation::corners_plus2;
    const bool all = mesh.face_varying == FaceVaryingInterpolation::boundaries;
    for (const auto& [point, here] : at_point) {
        const bool some_corner = std::any_of(
            here.begin(), here.end(), [&](int v) { return rims[static_cast<std::size_t>(v)].is_corner; });
        const bool whole = !rim_of(own, point).is_boundary;
        for (const int v : here) {
            const Rim& rim = rims[static_cast<std::size_t>(v)];
            const bool dart = whole && here.size() == 1 && rim.is_boundary;
            if (rim.is_corner || (all && rim.is_boundary) || (three_regions && here.size() > 2) ||
                (concave && (dart || (some_corner && here.size() == 2))))
                cage.corners.push_back({v, infinite_sharpness});
        }
    }
}

/// The mesh's own tags, where the cage goes on as the mesh does.
void copy_tags(const Mesh& mesh, const std::vector<Value>& values, Mesh& cage) {
    const Adjacency adjacency = build_adjacency(cage);
    std::map<std::pair<int, int>, float> sharpness;
    for (const Crease& crease : mesh.creases)
        sharpness[std::minmax(crease.v0, crease.v1)] = crease.sharpness;
    if (!sharpness.empty())
        for (int e = 0; e < adjacency.edge_count(); ++e) {
            const auto& [a, b] = adjacency.edge_points[static_cast<std::size_t>(e)];
            const auto found = sharpness.find(std::minmax(values[static_cast<std::size_t>(a)].first,
                                                          values[static_cast<std::size_t>(b)].first));
            const bool folded =
                is_interior_valence_two(adjacency, a) || is_interior_valence_two(adjacency, b);
            if (found != sharpness.end() && adjacency.corners_at_edge(e).size() > 1 && !folded)
                cage.creases.push_back({a, b, found->second});
        }
    std::map<int, float> at_point;
    for (const Corner& corner : mesh.corners)
        at_point[corner.vertex] = corner.sharpness;
    if (!at_point.empty())
        for (std::size_t v = 0; v < values.size(); ++v)
            if (const auto found = at_point.find(values[v].first); found != at_point.end())
                cage.corners.push_back({static_cast<int>(v), found->second});
}

} // namespace

bool has_linear_texcoords(const Mesh& mesh) {
    return mesh.scheme == Scheme::bilinear || mesh.face_varying == FaceVaryingInterpolation::all;
}

Mesh texture_cage(const Mesh& mesh) {
    Mesh cage;
    cage.name = mesh.name + " (texture coordinates)";
    cage.scheme = mesh.scheme;
    cage.face_sizes = mesh.face_sizes;
    cage.holes = mesh.holes;
    cage.boundary = BoundaryInterpolation::edge_only;
    cage.crease_method = mesh.crease_method;
    cage.triangles = mesh.triangles;
    std::map<Value, int> known;
    std::vector<Value> values;
    for (std::size_t corner = 0; corner < mesh.face_vertices.size(); ++corner) {
        const int coordinate = corner < mesh.face_texcoords.size() ? mesh.face_texcoords[corner] : -1;
        const Value value{mesh.face_vertices[corner], coordinate};
        const auto [entry, fresh] = known.try_emplace(value, static_cast<int>(values.size()));
        if (fresh) {
            values.push_back(value);
            const glm::vec2 uv =
                coordinate >= 0 ? mesh.texcoords[static_cast<std::size_t>(coordinate)] : glm::vec2(0);
            cage.points.emplace_back(uv.x, uv.y, 0);
        }
        cage.face_vertices.push_back(entry->second);
    }
    if (has_linear_texcoords(mesh))
        return cage;
    copy_tags(mesh, values, cage);
    sharpen_seams(mesh, values, cage);
    return cage;
}

Topology analyse_texture_cage(const Mesh& mesh, const Mesh& cage) {
    const Adjacency adjacency = build_adjacency(cage);
    Topology topology;
    for (const int size : cage.face_sizes)
        topology.faces.push_back({-1, 0, 0, size, 0});
    topology.points.resize(cage.points.size(), {-1, 0});
    if (has_linear_texcoords(mesh)) {
        topology.controls = cage.face_vertices;
        for (int f = 0; f < adjacency.face_count(); ++f) {
            topology.faces[static_cast<std::size_t>(f)].control_first = adjacency.first(f);
            topology.faces[static_cast<std::size_t>(f)].control_count = adjacency.size(f);
        }
        return topology;
    }
    assign_face_classes(cage, adjacency, faces_with_limit_surface(mesh), topology);
    topology.max_exponent = largest_exponent(cage, topology.classes);
    return topology;
}

} // namespace razor
