// What the plain path tracer's rays meet, in double: triangles of polygons, of faces that heights displace
// and of subdivided cages, each where a placement puts it.
#pragma once

#include "razor/scene/graph/affine.h"
#include "razor/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <vector>

namespace razor::test {

struct Facet {
    glm::dvec3 a, e1, e2, normal;
    const Material* material;
    /// Of what is not flat: normals at a, and from there to the other corners.
    glm::dvec3 smooth_a{0}, smooth_e1{0}, smooth_e2{0};
    glm::dvec2 uv_a{0}, uv_e1{0}, uv_e2{0}; // texture coordinates likewise
    const Texture* holes = nullptr;         // that cuts out of it
};

/// Facets, and a box about them: rays that miss it miss them.
struct Body {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    std::vector<Facet> facets;
    Affine to_object{};
    double scale = 1; // of the object's lengths

    void add(const Facet& f);
    bool may_meet(const glm::dvec3& o, const glm::dvec3& d) const;
};

struct Meeting {
    double t = std::numeric_limits<double>::infinity(), u = 0, v = 0;
    const Facet* facet = nullptr;
    const Body* body = nullptr;
};

/// Whether the ray meets it before `m`, which then says so. Backs of what has one side are not there, nor is
/// what is cut out.
bool meet(const Body& body, const Facet& facet, const glm::dvec3& origin, const glm::dvec3& direction,
          Meeting& m);

/// Of each mesh wherever it is drawn, or a part of it: bilinear ones of planar convex faces as they are,
/// others closed, as plain_cage.h takes them; displaced ones of bilinear quads with texture coordinates.
std::vector<Body> plain_bodies(const Scene& scene);

} // namespace razor::test
