// A ray against triangles: watertight (Woop, Benthin & Wald, JCGT 2013), in double precision, with all
// crossings.
//
// Vertices are sheared into the ray's frame, where the ray is the z axis; a triangle is crossed if the origin
// of the plane is inside it. Edge functions are exact in sign: equal rounded products are told apart by their
// rounding errors. Where one is truly zero the ray passes through an edge or a vertex, and is taken to pass
// beside it, at (e, e^2), e infinitely small: so every closed complex is crossed an even number of times
// along a whole line, with no case left over, and triangles seen edge-on are never crossed.
#pragma once

#include "tests/reference/soup.h"

#include <vector>

namespace razor::reference {

struct Ray {
    glm::dvec3 origin, direction;
};

struct Crossing {
    double t = 0;
    int triangle = -1; // of the soup
    double along[2]{}; // barycentric weights of its second and third vertex
};

class RayFrame {
public:
    explicit RayFrame(const Ray& ray);
    glm::dvec3 shear(const glm::dvec3& p) const;
    /// Distance along the ray, in lengths of its direction, of a sheared point's z.
    double t(double z) const { return z * scale_; }
    /// A triangle's crossing by sheared vertices; false: none.
    bool cross(const std::array<glm::dvec3, 3>& p, bool sliver, Crossing& crossing) const;

private:
    int kx_, ky_, kz_;
    double shear_x_, shear_y_, scale_;
    glm::dvec3 origin_;
};

/// All crossings of the whole line, in the triangles' order.
std::vector<Crossing> crossings(const Ray& ray, const Soup& soup);

/// Crossings with 0 < t.
struct Hits {
    int count = 0;
    Crossing nearest; // triangle -1: none
};
Hits hits(const Ray& ray, const Soup& soup);

} // namespace razor::reference
