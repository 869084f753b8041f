// Collects the points, faces and creases of a generated cage.
#pragma once

#include "razor/scene/scene.h"

#include <initializer_list>
#include <map>
#include <tuple>
#include <vector>

namespace razor {

class CageBuilder {
public:
    /// Adds a point and returns its index.
    int point(double x, double y, double z) {
        mesh_.points.emplace_back(x, y, z);
        return static_cast<int>(mesh_.points.size()) - 1;
    }
    int point(const glm::dvec3& p) { return point(p.x, p.y, p.z); }

    /// Adds a face; corners counter-clockwise seen from outside.
    void face(std::initializer_list<int> corners) { add_face(corners); }
    void face(const std::vector<int>& corners) { add_face(corners); }

    /// Likewise, with texture coordinates of each corner. Faces that give a point the same ones are
    /// continuous there. A cage has them at all faces or at none.
    void face(const std::vector<int>& corners, const std::vector<glm::dvec2>& coordinates) {
        add_face(corners);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::vec2 at(coordinates[i]);
            const auto [entry, is_new] =
                known_.try_emplace({corners[i], at.x, at.y}, static_cast<int>(mesh_.texcoords.size()));
            if (is_new)
                mesh_.texcoords.push_back(at);
            mesh_.face_texcoords.push_back(entry->second);
        }
    }

    /// Sharpens the edge a-b; nothing where sharpness is 0.
    void crease(int a, int b, double sharpness) {
        if (sharpness > 0) {
            mesh_.creases.push_back({a, b, static_cast<float>(sharpness)});
        }
    }

    const std::vector<glm::dvec3>& points() const { return mesh_.points; }
    Mesh take() { return std::move(mesh_); }

private:
    template <typename Corners> void add_face(const Corners& corners) {
        mesh_.face_sizes.push_back(static_cast<int>(corners.size()));
        mesh_.face_vertices.insert(mesh_.face_vertices.end(), corners.begin(), corners.end());
    }

    Mesh mesh_;
    std::map<std::tuple<int, float, float>, int> known_; // texture coordinates of points
};

} // namespace razor
