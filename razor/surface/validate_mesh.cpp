// What a cage must satisfy before anything else looks at it. OpenSubdiv 3.5 crashes on bad indices and
// accepts repeated corners silently, so everything is checked here.
#include "razor/scene/mesh_error.h"
#include "razor/surface/adjacency.h"
#include "razor/surface/limits.h"
#include "razor/surface/topology.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace razor {
namespace {

template <class... Args>
[[noreturn]] void fail(const Mesh& mesh, fmt::format_string<Args...> text, Args&&... args) {
    throw MeshError(mesh.name,
                    fmt::format("mesh '{}': {}", mesh.name, fmt::format(text, std::forward<Args>(args)...)));
}

bool in_range(int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
}

void check_points(const Mesh& mesh, const std::vector<glm::dvec3>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const double x = points[i][axis];
            if (!std::isfinite(x)) {
                fail(mesh, "point {} (counted from 0) has a coordinate that is not finite; give it a number",
                     i);
            }
            if (std::abs(x) > largest_coordinate) {
                fail(mesh,
                     "point {} (counted from 0) has the coordinate {:g}, beyond {:g}; scale the mesh down", i,
                     x, largest_coordinate);
            }
        }
    }
}

void check_sizes(const Mesh& mesh) {
    if (mesh.face_sizes.empty()) {
        fail(mesh, "there is no face; give at least one");
    }
    const bool smooth = mesh.scheme == Scheme::catmull_clark;
    const int cap = smooth ? largest_subdivision_face : largest_bilinear_face;
    std::size_t corners = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        const int size = mesh.face_sizes[f];
        if (size < 3) {
            fail(mesh, "face {} (counted from 0) has {} corners; it needs 3 or more", f, size);
        }
        if (size > cap) {
            fail(mesh,
                 "face {} (counted from 0) has {} corners; a {} face may have at most {}, so split it{}", f,
                 size, smooth ? "subdivision" : "bilinear", cap,
                 smooth && size <= largest_bilinear_face ? ", or render the mesh as bilinear" : "");
        }
        corners += static_cast<std::size_t>(size);
    }
    if (corners != mesh.face_vertices.size()) {
        fail(mesh, "its face sizes add up to {} corners, but there are {} corner indices; make them agree",
             corners, mesh.face_vertices.size());
    }
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 4;
    if (corners > most || mesh.points.size() > most) {
        fail(mesh, "it has more than {} corners or points; split it into several meshes", most);
    }
}

void check_face(const Mesh& mesh, std::size_t face, std::size_t first, std::vector<std::size_t>& last_face) {
    const auto size = static_cast<std::size_t>(mesh.face_sizes[face]);
    std::size_t distinct = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const int point = mesh.face_vertices[first + i];
        if (!in_range(point, mesh.points.size())) {
            fail(mesh,
                 "face {} (counted from 0), corner {}: point {} does not exist (there are {}); correct the "
                 "index",
                 face, i, point, mesh.points.size());
        }
        if (point == mesh.face_vertices[first + (i + 1) % size]) {
            fail(mesh, "face {} (counted from 0) has point {} (counted from 0) twice in a row; remove one",
                 face, point);
        }
        const bool repeated = last_face[static_cast<std::size_t>(point)] == face + 1;
        if (repeated && mesh.scheme == Scheme::catmull_clark) {
            fail(mesh,
                 "face {} (counted from 0) has point {} (counted from 0) at two corners; split the face, or "
                 "render the mesh "
                 "as bilinear",
                 face, point);
        }
        distinct += repeated ? 0 : 1;
        last_face[static_cast<std::size_t>(point)] = face + 1;
    }
    if (distinct < 3) {
        fail(mesh, "face {} (counted from 0) has {} distinct corners; it needs 3 or more", face, distinct);
    }
}

void check_texcoords(const Mesh& mesh) {
    if (mesh.face_texcoords.empty()) {
        return;
    }
    if (mesh.face_texcoords.size() != mesh.face_vertices.size()) {
        fail(mesh, "it has {} texture coordinate indices for {} corners; give one for each corner, or none",
             mesh.face_texcoords.size(), mesh.face_vertices.size());
    }
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        for (int i = 0; i < mesh.face_sizes[f]; ++i, ++corner) {
            if (!in_range(mesh.face_texcoords[corner], mesh.texcoords.size())) {
                fail(mesh,
                     "face {} (counted from 0), corner {}: texture coordinate {} does not exist (there are "
                     "{}); correct the "
                     "index",
                     f, i, mesh.face_texcoords[corner], mesh.texcoords.size());
            }
        }
    }
    for (std::size_t i = 0; i < mesh.texcoords.size(); ++i) {
        if (!std::isfinite(mesh.texcoords[i].x) || !std::isfinite(mesh.texcoords[i].y)) {
            fail(mesh, "texture coordinate {} (counted from 0) is not finite; give it numbers", i);
        }
    }
}

void check_sharpness(const Mesh& mesh, float sharpness, const std::string& what) {
    if (!(sharpness >= 0) || !std::isfinite(sharpness)) {
        fail(mesh, "{} has sharpness {}; give a number from 0 to {} (infinitely sharp)", what, sharpness,
             infinite_sharpness);
    }
}

void check_tags(const Mesh& mesh) {
    for (const Corner& corner : mesh.corners) {
        if (!in_range(corner.vertex, mesh.points.size())) {
            fail(mesh,
                 "a corner tag names point {} (counted from 0), which does not exist (there are {}); correct "
                 "or remove it",
                 corner.vertex, mesh.points.size());
        }
        check_sharpness(mesh, corner.sharpness,
                        fmt::format("the corner at point {} (counted from 0)", corner.vertex));
    }
    for (const int hole : mesh.holes) {
        if (!in_range(hole, mesh.face_sizes.size())) {
            fail(mesh,
                 "a hole tag names face {} (counted from 0), which does not exist (there are {}); correct or "
                 "remove it",
                 hole, mesh.face_sizes.size());
        }
    }
    if (mesh.creases.empty()) {
        return;
    }
    const Adjacency adjacency = build_adjacency(mesh);
    for (const Crease& crease : mesh.creases) {
        for (const int v : {crease.v0, crease.v1}) {
            if (!in_range(v, mesh.points.size())) {
                fail(mesh,
                     "a crease names point {} (counted from 0), which does not exist (there are {}); correct "
                     "or remove it",
                     v, mesh.points.size());
            }
        }
        if (adjacency.find_edge(crease.v0, crease.v1) < 0) {
            fail(mesh,
                 "a crease joins points {} and {} (counted from 0), which is not an edge of any face; remove "
                 "it",
                 crease.v0, crease.v1);
        }
        check_sharpness(
            mesh, crease.sharpness,
            fmt::format("the crease between points {} and {} (counted from 0)", crease.v0, crease.v1));
    }
}

} // namespace

void validate_mesh(const Mesh& mesh) {
    check_points(mesh, mesh.points);
    check_points(mesh, mesh.rest);
    if (!mesh.rest.empty() && mesh.rest.size() != mesh.points.size()) {
        fail(mesh, "it has {} points, and {} at rest; give as many", mesh.points.size(), mesh.rest.size());
    }
    check_sizes(mesh);
    std::vector<std::size_t> last_face(mesh.points.size(), 0);
    std::size_t first = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        check_face(mesh, f, first, last_face);
        first += static_cast<std::size_t>(mesh.face_sizes[f]);
    }
    check_texcoords(mesh);
    if (!mesh.face_materials.empty() && mesh.face_materials.size() != mesh.face_sizes.size()) {
        fail(mesh, "it has materials of {} faces, but {} faces; give each one, or none",
             mesh.face_materials.size(), mesh.face_sizes.size());
    }
    check_tags(mesh);
    if (!(mesh.edge_length >= 0) || !std::isfinite(mesh.edge_length)) {
        fail(mesh, "its edge length is {}; give a positive length, or 0 to take it from the camera",
             mesh.edge_length);
    }
}

} // namespace razor
