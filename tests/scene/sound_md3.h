// What holds of every MD3 model that loads, whatever its bytes.
#pragma once

#include "razor/scene/models/md3_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace razor {

inline bool in_range(const std::vector<int>& indices, std::size_t count) {
    return std::all_of(indices.begin(), indices.end(),
                       [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < count; });
}

inline bool sound(const Md3Model& model) {
    const Mesh& cage = model.cage;
    const std::vector<int>& corners = cage.face_vertices;
    bool good = !cage.face_sizes.empty() && corners.size() == 3 * cage.face_sizes.size() &&
                cage.face_texcoords.size() == corners.size() && in_range(corners, cage.points.size()) &&
                in_range(cage.face_texcoords, cage.texcoords.size()) && !model.frames.empty() &&
                model.frames.front() == cage.points;
    good = good && model.face_surfaces.size() == cage.face_sizes.size() &&
           in_range(model.face_surfaces, model.surfaces.size());
    for (const int size : cage.face_sizes) {
        good = good && size == 3;
    }
    for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
        good = good && corners[c] != corners[c + 1] && corners[c + 1] != corners[c + 2] &&
               corners[c + 2] != corners[c];
    }
    for (const auto& frame : model.frames) {
        good = good && frame.size() == cage.points.size();
        for (const glm::dvec3& p : frame) {
            good = good && std::abs(p.x) <= 512 && std::abs(p.y) <= 512 && std::abs(p.z) <= 512;
        }
    }
    for (const glm::vec2& t : cage.texcoords) {
        good = good && std::isfinite(t.x) && std::isfinite(t.y);
    }
    return good;
}

} // namespace razor
