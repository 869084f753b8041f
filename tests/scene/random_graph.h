// Scene graphs of any shape, at random or piece by piece.
#pragma once

#include "razor/scene/graph/flatten.h"
#include "razor/scene/graph/records.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace razor {

class Random {
public:
    explicit Random(unsigned seed) : random_(seed) {}
    double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    glm::dvec3 vector(double low, double high) {
        return {uniform(low, high), uniform(low, high), uniform(low, high)};
    }
    double sign() { return whole(0, 1) == 0 ? 1 : -1; }
    /// Between 10^-decades and 10^decades.
    double scale(double decades) { return std::pow(10.0, uniform(-decades, decades)); }
    glm::dmat3 turn() {
        Transform t;
        t.rotate = vector(-400, 400);
        return to_affine(t).linear;
    }
    Transform transform(double decades) {
        Transform t;
        const double size = scale(decades);
        t.scale =
            size * glm::dvec3(sign() * uniform(0.3, 3), sign() * uniform(0.3, 3), sign() * uniform(0.3, 3));
        t.rotate = vector(-400, 400);
        t.translate = vector(-10, 10);
        if (whole(0, 2) == 0) {
            t.rotate = 90.0 * glm::dvec3(whole(-5, 5), whole(-5, 5), whole(-5, 5));
        }
        if (whole(0, 3) == 0) { // sheared
            t.matrix =
                Affine{to_affine(t).linear * glm::dmat3(1, 0, 0, uniform(-2, 2), 1, 0, 0, uniform(-2, 2), 1),
                       t.translate};
        }
        return t;
    }
    std::mt19937& engine() { return random_; }

private:
    std::mt19937 random_; // NOLINT(cert-msc32-c,cert-msc51-cpp)
};

inline const Box unit_box{{-1, -1, -1}, {1, 1, 1}};

inline Placement place(int mesh, const Transform& local = {}) {
    return {.name = "mesh", .mesh = mesh, .local = local};
}
inline Placement place_group(int group, const Transform& local = {}) {
    return {.name = "group", .group = group, .local = local};
}
inline Transform scaled(double s) {
    return {.scale = glm::dvec3(s)};
}

/// Groups place meshes and groups of higher number.
inline SceneGraph random_graph(Random& random, int groups, int meshes) {
    SceneGraph graph;
    for (int g = 0; g < groups; ++g) {
        Group group{fmt::format("g{}", g), {}};
        const int count = random.whole(1, 3);
        for (int i = 0; i < count; ++i) {
            const bool deeper = g + 1 < groups && random.whole(0, 3) != 0;
            Placement p =
                deeper ? place_group(random.whole(g + 1, groups - 1)) : place(random.whole(0, meshes - 1));
            p.local = random.transform(1);
            p.level_offset = random.whole(-2, 2);
            p.rate = random.scale(0.3);
            p.material = random.whole(-2, 2);
            if (random.whole(0, 4) == 0) {
                p.copies = {random.whole(1, 3), random.whole(1, 2), random.whole(1, 2)};
                p.spacing = random.vector(-5, 5);
            }
            group.placements.push_back(p);
        }
        graph.groups.push_back(group);
    }
    return graph;
}

} // namespace razor
