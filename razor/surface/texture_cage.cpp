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

/// How the faces around a point hang together.
struct Around {
    int faces = 0;
    int fans = 0;         // of faces that follow each other
    bool is_open = false; // some fan does not close
};

Around around(const Adjacency& adjacency, int point) {
    const std::span<const int> corners = adjacency.corners_at_point(point);
    Around result{static_cast<int>(corners.size())};
    for (std::set<int> left(corners.begin(), corners.end()); !left.empty(); ++result.fans) {
        const int first = *left.begin();
        int c = first;
        do {
            left.erase(c);
            c = adjacency.counter_clockwise(c);
        } while (c >= 0 && c != first);
        if (c >= 0)
            continue;
        result.is_open = true;
        for (c = adjacency.clockwise(first); c >= 0; c = adjacency.clockwise(c))
            left.erase(c);
    }
    return result;
}

/// Of each point of the cage the sharpest crease that ends there.
std::vector<float> sharpest_creases(const Mesh& cage) {
    std::vector<float> sharpest(cage.points.size(), 0.0F);
    for (const Crease& crease : cage.creases)
        for (const int v : {crease.v0, crease.v1}) {
            float& most = sharpest[static_cast<std::size_t>(v)];
            most = std::max(most, crease.sharpness);
        }
    return sharpest;
}

/// Whether the rule makes a boundary's point a corner. `own`: around it in the cage, `whole`: in the mesh,
/// where `fans` hold together in both.
bool is_sharp(const Mesh& mesh, const Around& own, const Around& whole, int fans) {
    if (mesh.face_varying == FaceVaryingInterpolation::none)
        return whole.faces == 1 && mesh.boundary == BoundaryInterpolation::edge_and_corner;
    if (own.faces == 1 || mesh.face_varying == FaceVaryingInterpolation::boundaries)
        return true;
    if (mesh.face_varying == FaceVaryingInterpolation::corners_only)
        return false;
    const int others = whole.faces - own.faces;
    const bool is_dart = others == 0 && !whole.is_open;
    return fans > 2 ||
           (mesh.face_varying == FaceVaryingInterpolation::corners_plus2 && (is_dart || others == 1));
}

/// Points that are sharp by the rule; last, as it overrides the mesh's own corners.
void sharpen_seams(const Mesh& mesh, const std::vector<Value>& values, Mesh& cage) {
    const Adjacency adjacency = build_adjacency(cage);
    const Adjacency own = build_adjacency(mesh);
    std::map<int, std::vector<int>> at_point; // of the mesh
    for (std::size_t v = 0; v < values.size(); ++v)
        at_point[values[v].first].push_back(static_cast<int>(v));
    const std::vector<float> sharpest = sharpest_creases(cage);
    std::vector<float> corners(cage.points.size(), 0.0F);
    for (const Corner& corner : cage.corners)
        corners[static_cast<std::size_t>(corner.vertex)] = corner.sharpness;
    const bool by_others = mesh.face_varying == FaceVaryingInterpolation::corners_plus1 ||
                           mesh.face_varying == FaceVaryingInterpolation::corners_plus2;
    for (const auto& [point, here] : at_point) {
        const Around whole = around(own, point);
        std::vector<Around> parts;
        int fans = 0;
        for (const int v : here) {
            parts.push_back(around(adjacency, v));
            fans += parts.back().fans;
        }
        for (std::size_t i = 0; i < here.size(); ++i) {
            float sharpness = 0;
            if (whole.fans > 1 || (parts[i].is_open && is_sharp(mesh, parts[i], whole, fans))) {
                sharpness = infinite_sharpness;
            } else if (by_others && parts[i].is_open && sharpest[static_cast<std::size_t>(here[i])] == 0) {
                // A crease that ends at a seam sharpens what lies on the other side of it as well.
                for (const int v : here)
                    sharpness = std::max(sharpness, sharpest[static_cast<std::size_t>(v)]);
            }
            if (sharpness > corners[static_cast<std::size_t>(here[i])])
                cage.corners.push_back({here[i], sharpness});
        }
    }
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

Topology analyse_texture_cage(const Mesh& mesh, const Mesh& cage, bool displaced) {
    const Adjacency adjacency = build_adjacency(cage);
    Topology topology;
    topology.displaced = displaced;
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
