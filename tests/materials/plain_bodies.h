// What the plain path tracer's rays meet, in double: triangles of polygons, and of faces that heights
// displace.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <limits>
#include <vector>

namespace razor::test {

struct Facet {
    glm::dvec3 a, e1, e2, normal;
    const Material* material;
    /// Of a part of a displaced face: normals of the heights at a, and from there to the other corners.
    glm::dvec3 smooth_a{0}, smooth_e1{0}, smooth_e2{0};
};

/// Facets, and a box about them: rays that miss it miss them.
struct Body {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    std::vector<Facet> facets;

    void add(const Facet& f);
    bool may_meet(const glm::dvec3& o, const glm::dvec3& d) const;
};

struct Meeting {
    double t = std::numeric_limits<double>::infinity(), u = 0, v = 0;
    const Facet* facet = nullptr;
};

/// Whether the ray meets it before `m`, which then says so. Backs of what has one side are not there.
bool meet(const Facet& facet, const glm::dvec3& origin, const glm::dvec3& direction, Meeting& m);

/// Of each mesh of planar convex faces where its points lie; displaced ones of quads with texture
/// coordinates.
std::vector<Body> plain_bodies(const Scene& scene);

} // namespace razor::test
