// What must hold of any cage that a reader gives.
#pragma once

#include "razor/scene/scene.h"
#include "tests/fuzz/target.h"

#include <algorithm>
#include <cmath>

namespace fuzz {

inline void require_sound(const razor::Mesh& mesh) {
    std::size_t corners = 0;
    for (const int size : mesh.face_sizes) {
        require(size >= 3);
        corners += static_cast<std::size_t>(size);
    }
    require(!mesh.face_sizes.empty() && corners == mesh.face_vertices.size());
    require(mesh.face_texcoords.empty() || mesh.face_texcoords.size() == corners);
    const auto below = [](std::size_t count) {
        return [count](int index) { return index >= 0 && static_cast<std::size_t>(index) < count; };
    };
    require(std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(), below(mesh.points.size())));
    require(
        std::all_of(mesh.face_texcoords.begin(), mesh.face_texcoords.end(), below(mesh.texcoords.size())));
    require(std::all_of(mesh.holes.begin(), mesh.holes.end(), below(mesh.face_sizes.size())));
    for (const razor::Crease& crease : mesh.creases)
        require(below(mesh.points.size())(crease.v0) && below(mesh.points.size())(crease.v1) &&
                crease.sharpness >= 0);
    for (const razor::Corner& corner : mesh.corners)
        require(below(mesh.points.size())(corner.vertex) && corner.sharpness >= 0);
    for (const auto& p : mesh.points)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (const auto& uv : mesh.texcoords)
        require(std::isfinite(uv.x) && std::isfinite(uv.y));
}

} // namespace fuzz
