#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 3> parameters{{
    {"length", 0.75, 1e-3, 10, false}, // of the arms, in radii of the dodecahedron's inscribed sphere
    {"taper", 0.5, 0.01, 2, false},    // size of an arm's end against its root
    {"sharpness", 0, 0, 10, false},    // of the ends' rims
}};

/// The twelve face directions of a dodecahedron: the corners of an icosahedron.
std::vector<glm::dvec3> face_directions() {
    std::vector<glm::dvec3> directions;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double a : {-1.0, 1.0}) {
            for (const double b : {-1.0, 1.0}) {
                glm::dvec3 d{0};
                d[(axis + 1) % 3] = a;
                d[(axis + 2) % 3] = b * std::numbers::phi;
                directions.push_back(glm::normalize(d));
            }
        }
    }
    return directions;
}

/// The twenty corners of a dodecahedron on the unit sphere.
std::vector<glm::dvec3> corners() {
    std::vector<glm::dvec3> points;
    for (int c = 0; c < 8; ++c) {
        points.push_back(glm::normalize(glm::dvec3((c & 1) * 2 - 1, (c >> 1 & 1) * 2 - 1, (c >> 2) * 2 - 1)));
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const double a : {-1.0, 1.0}) {
            for (const double b : {-1.0, 1.0}) {
                glm::dvec3 p{0};
                p[(axis + 1) % 3] = a * std::numbers::phi;
                p[(axis + 2) % 3] = b / std::numbers::phi;
                points.push_back(glm::normalize(p));
            }
        }
    }
    return points;
}

Mesh make(std::span<const double> values) {
    CageBuilder cage;
    const std::vector<glm::dvec3> body = corners();
    for (const glm::dvec3& p : body) {
        cage.point(p);
    }
    for (const glm::dvec3& normal : face_directions()) {
        const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.8)));
        const glm::dvec3 v = glm::cross(normal, u);
        std::vector<int> root(body.size());
        for (std::size_t i = 0; i < root.size(); ++i) {
            root[i] = static_cast<int>(i);
        }
        const auto at = [&](int i) { return body[std::size_t(i)]; };
        std::sort(root.begin(), root.end(),
                  [&](int a, int b) { return glm::dot(at(a), normal) > glm::dot(at(b), normal); });
        root.resize(5); // the face's corners, now in order around it
        const auto angle = [&](int i) { return std::atan2(glm::dot(at(i), v), glm::dot(at(i), u)); };
        std::sort(root.begin(), root.end(), [&](int a, int b) { return angle(a) < angle(b); });

        const double inscribed = glm::dot(at(root[0]), normal);
        std::vector<int> tip;
        for (const int i : root) {
            const glm::dvec3 centre = inscribed * normal;
            tip.push_back(cage.point(centre + values[1] * (at(i) - centre) + values[0] * inscribed * normal));
        }
        for (std::size_t i = 0; i < 5; ++i) {
            const std::size_t j = (i + 1) % 5;
            cage.face({root[i], root[j], tip[j], tip[i]});
            cage.crease(tip[i], tip[j], values[2]);
        }
        cage.face(tip);
    }
    return cage.take();
}

} // namespace

ShapeKind urchin_kind() {
    return {"urchin", parameters, make};
}

} // namespace razor
