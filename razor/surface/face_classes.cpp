#include "razor/surface/face_classes.h"

#include "razor/scene/mesh_error.h"
#include "razor/surface/limits.h"
#include "razor/surface/neighbourhood.h"

#include <fmt/format.h>

#include <limits>
#include <unordered_map>

namespace razor {
namespace {

using Signature = std::vector<std::int32_t>;

struct SignatureHash { // FNV-1a over the words; equality is compared in full
    std::size_t operator()(const Signature& s) const {
        std::uint64_t h = 14695981039346656037ULL;
        for (const std::int32_t word : s) {
            h = (h ^ static_cast<std::uint32_t>(word)) * 1099511628211ULL;
        }
        return static_cast<std::size_t>(h);
    }
};

/// OpenSubdiv 3.5 crashes on sharp edges that end at an interior point with only two faces.
void reject_creases_at_valence_two(const Mesh& mesh, const Adjacency& adjacency) {
    for (const Crease& crease : mesh.creases) {
        for (const int v : {crease.v0, crease.v1}) {
            if (crease.sharpness > 0 && is_interior_valence_two(adjacency, v)) {
                throw UserError(fmt::format(
                    "mesh '{}', face {} (counted from 0): the crease between points {} and {} (counted "
                    "from 0) ends inside the surface at a point of only two faces, which OpenSubdiv "
                    "cannot evaluate; remove the crease",
                    mesh.name, adjacency.face(adjacency.corners_at_point(v)[0]), crease.v0, crease.v1));
            }
        }
    }
}

} // namespace

void assign_face_classes(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                         Topology& topology) {
    reject_creases_at_valence_two(mesh, adjacency);
    const Sharpness sharpness = gather_sharpness(mesh, adjacency);
    NeighbourhoodWalker walker(adjacency, sharpness);
    std::unordered_map<Signature, int, SignatureHash> known;
    for (int f = 0; f < adjacency.face_count(); ++f) {
        if (!drawn[static_cast<std::size_t>(f)]) {
            continue;
        }
        const Neighbourhood& n = walker.visit(f, largest_control_count);
        if (static_cast<int>(n.controls.size()) > largest_control_count) {
            throw MeshError(
                mesh.name,
                fmt::format("mesh '{}', face {} (counted from 0): its limit surface depends on more than {} "
                            "points; split the large faces or the high valences around it, or render the "
                            "mesh as bilinear",
                            mesh.name, f, largest_control_count));
        }
        if (topology.controls.size() + n.controls.size() >
            static_cast<std::size_t>(std::numeric_limits<int>::max())) {
            throw UserError(fmt::format(
                "mesh '{}': its faces have more than {} control points together; split it into several "
                "meshes",
                mesh.name, std::numeric_limits<int>::max()));
        }
        const auto next_class = static_cast<int>(topology.classes.size());
        const auto [entry, is_new] =
            known.try_emplace(n.signature, next_class); // regular faces: the empty signature
        if (is_new) {
            topology.classes.push_back(
                {f, static_cast<int>(n.controls.size()), adjacency.size(f), n.regular, n.folded, n.fading});
        }
        FaceRecord& record = topology.faces[static_cast<std::size_t>(f)];
        record.face_class = entry->second;
        record.control_first = static_cast<int>(topology.controls.size());
        record.control_count = static_cast<int>(n.controls.size());
        topology.controls.insert(topology.controls.end(), n.controls.begin(), n.controls.end());
    }
}

void assign_straight_classes(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                             Topology& topology) {
    topology.controls = mesh.face_vertices;
    std::unordered_map<int, int> of_size;
    for (int f = 0; f < adjacency.face_count(); ++f) {
        const int size = adjacency.size(f);
        FaceRecord& record = topology.faces[static_cast<std::size_t>(f)];
        record.control_first = adjacency.first(f);
        record.control_count = size;
        if (!drawn[static_cast<std::size_t>(f)]) {
            continue;
        }
        const auto [entry, is_new] = of_size.try_emplace(size, static_cast<int>(topology.classes.size()));
        if (is_new) {
            topology.classes.push_back({f, size, size, false, false, false, true});
        }
        record.face_class = entry->second;
    }
}

} // namespace razor
