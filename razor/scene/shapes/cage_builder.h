// Collects the points, faces and creases of a generated cage.
#pragma once

#include "razor/scene/scene.h"

#include <initializer_list>
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
};

} // namespace razor
