#include "razor/check/mesh_report.h"

#include "razor/surface/adjacency.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace razor::check {

namespace {

/// Sets of numbers that are joined one pair after the other.
class Groups {
public:
    explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
    int root(int i) {
        while (parent_[static_cast<std::size_t>(i)] != i)
            i = parent_[static_cast<std::size_t>(i)] =
                parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
        return i;
    }
    void join(int a, int b) { parent_[static_cast<std::size_t>(root(a))] = root(b); }

private:
    std::vector<int> parent_;
};

glm::dvec3 point_of(const Mesh& mesh, const Adjacency& a, int corner) {
    return mesh.points[static_cast<std::size_t>(a.point(corner))];
}

/// The area over the square of the longest edge.
double slenderness(const Mesh& mesh, const Adjacency& a, int face) {
    const glm::dvec3 first = point_of(mesh, a, a.first(face));
    glm::dvec3 area(0);
    double longest = 0;
    for (int c = a.first(face); c < a.first(face) + a.size(face); ++c) {
        const glm::dvec3 p = point_of(mesh, a, c), q = point_of(mesh, a, a.next_corner(c));
        area += 0.5 * glm::cross(p - first, q - first);
        longest = std::max(longest, glm::length(q - p));
    }
    return longest > 0 ? glm::length(area) / (longest * longest) : 0;
}

constexpr double no_area = 0.5e-12, sliver = 1e-4;
constexpr int high_valence = 64;

void find_repeated_faces(const Mesh& mesh, const Adjacency& a, MeshReport& r) {
    std::set<std::vector<int>> seen;
    for (int f = 0; f < r.faces; ++f) {
        const auto first = mesh.face_vertices.begin() + a.first(f);
        std::vector<int> points(first, first + a.size(f));
        std::sort(points.begin(), points.end());
        if (!seen.insert(std::move(points)).second)
            r.repeated_faces.add(f);
    }
}

void find_semi_sharp(const Mesh& mesh, MeshReport& r) {
    const auto is_semi = [](float sharpness) { return sharpness > 0 && sharpness < infinite_sharpness; };
    for (const Crease& c : mesh.creases)
        if (is_semi(c.sharpness))
            r.semi_sharp.add(c.v0, c.v1);
    for (const Corner& c : mesh.corners)
        if (is_semi(c.sharpness))
            r.semi_sharp.add(c.vertex, c.vertex);
}

/// Fans of faces about a point that are joined by edges.
int fans(const Adjacency& a, int point) {
    const auto corners = a.corners_at_point(point);
    Groups groups(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            for (const int edge : {a.leading_edge(corners[i]), a.trailing_edge(corners[i])})
                if (edge == a.leading_edge(corners[j]) || edge == a.trailing_edge(corners[j]))
                    groups.join(static_cast<int>(i), static_cast<int>(j));
    int n = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        n += groups.root(static_cast<int>(i)) == static_cast<int>(i) ? 1 : 0;
    return n;
}

void find_bodies(const Mesh& mesh, const Adjacency& a, MeshReport& r) {
    Groups groups(mesh.points.size());
    for (int c = 0; c < static_cast<int>(mesh.face_vertices.size()); ++c)
        groups.join(a.point(c), a.point(a.next_corner(c)));
    std::vector<int> number(mesh.points.size(), -1);
    for (int f = 0; f < a.face_count(); ++f) {
        int& n = number[static_cast<std::size_t>(groups.root(a.point(a.first(f))))];
        if (n < 0)
            n = r.bodies++;
        r.body_of_face.push_back(n);
    }
    r.body_is_closed.assign(static_cast<std::size_t>(r.bodies), true);
    const auto open = [&](int face) {
        r.body_is_closed[static_cast<std::size_t>(r.body_of_face[static_cast<std::size_t>(face)])] = false;
    };
    for (int e = 0; e < a.edge_count(); ++e)
        if (a.corners_at_edge(e).size() != 2)
            open(a.face(a.corners_at_edge(e)[0]));
    for (const int face : mesh.holes)
        open(face);
    r.closed_bodies = static_cast<int>(std::count(r.body_is_closed.begin(), r.body_is_closed.end(), true));
}

} // namespace

MeshReport examine(const Mesh& mesh) {
    const Adjacency a = build_adjacency(mesh);
    MeshReport r;
    r.name = mesh.name;
    r.points = static_cast<int>(mesh.points.size());
    r.faces = a.face_count();
    for (int f = 0; f < r.faces; ++f) {
        ++(a.size(f) == 3 ? r.triangles : a.size(f) == 4 ? r.quads : r.larger);
        const double area = slenderness(mesh, a, f);
        if (!(area > no_area))
            r.degenerate_faces.add(f);
        else if (area < sliver)
            r.slivers.add(f);
    }
    for (int e = 0; e < a.edge_count(); ++e) {
        const auto [p, q] = a.edge_points[static_cast<std::size_t>(e)];
        const auto corners = a.corners_at_edge(e);
        if (corners.size() == 1)
            r.open_edges.add(p, q);
        else if (corners.size() > 2)
            r.non_manifold_edges.add(p, q);
        else if (a.point(corners[0]) == a.point(corners[1]))
            r.opposed_edges.add(p, q);
    }
    for (int p = 0; p < r.points; ++p) {
        const auto valence = static_cast<int>(a.corners_at_point(p).size());
        r.largest_valence = std::max(r.largest_valence, valence);
        if (valence == 0)
            r.isolated_points.add(p);
        if (valence > high_valence)
            r.high_valence_points.add(p);
        if (valence > 0 && fans(a, p) > 1)
            r.pinched_points.add(p);
    }
    for (const int face : mesh.holes)
        r.hole_faces.add(face);
    find_repeated_faces(mesh, a, r);
    find_semi_sharp(mesh, r);
    find_bodies(mesh, a, r);
    return r;
}

Mesh closed_part(const Mesh& mesh, const MeshReport& report) {
    if (report.closed())
        return mesh;
    Mesh part = mesh;
    part.face_sizes.clear();
    part.face_vertices.clear();
    part.face_texcoords.clear();
    part.face_materials.clear();
    part.holes.clear();
    std::vector<bool> kept(mesh.points.size(), false);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        const int size = mesh.face_sizes[f];
        const bool keep = report.body_is_closed[static_cast<std::size_t>(report.body_of_face[f])];
        if (keep) {
            part.face_sizes.push_back(size);
            if (!mesh.face_materials.empty())
                part.face_materials.push_back(mesh.face_materials[f]);
        }
        for (int i = 0; i < size; ++i, ++corner) {
            if (!keep)
                continue;
            part.face_vertices.push_back(mesh.face_vertices[corner]);
            kept[static_cast<std::size_t>(mesh.face_vertices[corner])] = true;
            if (!mesh.face_texcoords.empty())
                part.face_texcoords.push_back(mesh.face_texcoords[corner]);
        }
    }
    const auto gone = [&](int point) { return !kept[static_cast<std::size_t>(point)]; };
    std::erase_if(part.creases, [&](const Crease& c) { return gone(c.v0); });
    std::erase_if(part.corners, [&](const Corner& c) { return gone(c.vertex); });
    return part;
}

Scene closed_part(const Scene& scene, const std::vector<MeshReport>& reports) {
    Scene part = scene;
    for (Material& material : part.materials)
        material.two_sided = true; // rays from inside are to meet it
    part.meshes.clear();
    std::vector<int> number;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const bool keep = reports[m].closed_bodies > 0;
        number.push_back(keep ? static_cast<int>(part.meshes.size()) : -1);
        if (keep)
            part.meshes.push_back(closed_part(scene.meshes[m], reports[m]));
    }
    for (Group& group : part.graph.groups) {
        std::erase_if(group.placements, [&](const Placement& p) {
            return p.mesh >= 0 && number[static_cast<std::size_t>(p.mesh)] < 0;
        });
        for (Placement& p : group.placements)
            if (p.mesh >= 0)
                p.mesh = number[static_cast<std::size_t>(p.mesh)];
    }
    return part;
}

} // namespace razor::check
