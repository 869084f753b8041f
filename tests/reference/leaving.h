// How far the surface that a spawned ray sees may be from the one its parent hit, near the hit.
//
// The child starts with the parent's footprint at the hit, W_h, and its footprints are taken from the hit h.
// At an anchor a with r = |a - h| the parent's footprint is within g_p r of W_h (footprints are Lipschitz in
// the anchor, and clamping from below keeps that), the child's within g_c r. With G = max(|g_p|, |g_c|) both
// lie in [W_h - G r, W_h + G r]; call the ends' weights w_k(-) >= w_k(+). Let L_k(v) be v at discrete level
// k.
//
//   T_k(v) >= |p_k - L_k| of either ray,   E_k(v) >= |p_k of the parent - p_k of the child|:
//     index(v) < k:  means of the parents';  k = top: 0;  else, with step = |L_k(v) - L_{k+1}(v)|,
//     T_k = (1 - w_k(+)) (T_{k+1} + step)
//     E_k = (w_k(-) - w_k(+)) (T_{k+1} + step) + (1 - w_k(+)) E_{k+1}
//
// since p_k^p - p_k^c = (w^p - w^c)(v_k - p_{k+1}^p) + (1 - w^c)(p_{k+1}^p - p_{k+1}^c). On the hit triangle
// the surfaces differ by at most the largest E_0 of its vertices.
//
// That bound alone does not end false self-shadowing: a convex body's triangulation has reflex edges, and the
// facet that was hit, blended, may be tilted against its neighbours. What does: begin above the plane through
// the hit, with the facet's normal, that has the neighbourhood below it. Whatever the child's growth, each of
// its vertices is a convex combination of vertices at some level, so it is below that plane too
// (`clearance`). On a convex body what rises above the facet's plane is a cap about the facet; R, how far the
// anchors are that the hit triangle is blended from, measures the facet. That twice R covers the cap is
// measured, not proved.
#pragma once

#include "tests/reference/schemes.h"

namespace razor::reference {

struct Hit {
    glm::dvec3 point{0};
    double footprint = 0;
    std::array<int, 3> vertices{}; // of the finest triangle that was hit
};

struct Apart {
    double from_level;      // T_0
    double from_each_other; // E_0
};

/// Largest over the hit triangle's vertices. `growth`: G. Pure function of the hit, not of either ray.
Apart apart(const Levels& levels, const Transition& transition, const Hit& hit, double growth);

/// How far along `normal` (unit, on the side to be left to) a spawned ray must begin beyond the hit: the
/// largest height of the neighbourhood, at any level, over the hit's plane.
double clearance(const Surface& parent, const Hit& hit, const glm::dvec3& normal);

} // namespace razor::reference
