// The one surface that a ray sees, with all vertices at their ray's positions.
//
// p_k(v), the position of v when levels below k are ignored:
//     index(v) < k:   the mean of p_k(parents)
//     else:           w_k(v) v_k + (1 - w_k(v)) p_{k+1}(v),     p_top(v) = v_top
// The surface is the finest triangulation with every vertex at p_0. w_k(v) is a function of the footprint at
// v's anchor alone, so p_k(v) is one of (vertex, ray origin, footprint): patches that share v agree on it.
#pragma once

#include "tests/reference/footprint.h"
#include "tests/reference/levels.h"

#include <optional>

namespace razor::reference {

/// What weights depend on.
struct View {
    glm::dvec3 origin{0};
    Footprint footprint;
    Transition transition;
    /// If given, distances are those of anchors' projections on the ray, as in the paper: then no two rays
    /// share a surface. Else they are distances from the origin.
    std::optional<glm::dvec3> direction{};

    double footprint_at(const glm::dvec3& anchor) const;
    double weight(int k, const glm::dvec3& anchor) const {
        return transition.weight(k, footprint_at(anchor));
    }
};

/// w v + (1 - w) c, exactly v at 1, exactly c at 0, and exactly c wherever v = c.
glm::dvec3 blend(double w, const glm::dvec3& v, const glm::dvec3& c);

class Surface {
public:
    Surface(const Levels& levels, const View& view);

    /// p_k(v), 0 <= k <= top.
    const glm::dvec3& position(int v, int k) const {
        return p_[static_cast<std::size_t>(k)][static_cast<std::size_t>(v)];
    }
    /// w_k(v); 1 at the top.
    double weight(int v, int k) const;
    const Levels& levels() const { return levels_; }
    const View& view() const { return view_; }

private:
    const Levels& levels_;
    View view_;
    std::vector<std::vector<glm::dvec3>> p_;
};

} // namespace razor::reference
