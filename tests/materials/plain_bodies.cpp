#include "tests/materials/plain_bodies.h"

#include "tests/displacement/heights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace razor::test {
namespace {

using glm::dvec3;

/// A quad moved along its normal by heights, cut into `parts` x `parts` squares.
struct DisplacedQuad {
    std::array<dvec3, 4> points;
    std::array<glm::dvec2, 4> texcoords;
    const Material& material;
    const Texture& texture;

    template <class Value> static Value at(const std::array<Value, 4>& corners, double u, double v) {
        return (1 - v) * ((1 - u) * corners[0] + u * corners[1]) +
               v * ((1 - u) * corners[3] + u * corners[2]);
    }
    dvec3 flat_normal() const {
        return glm::normalize(glm::cross(points[1] - points[0], points[3] - points[0]));
    }
    dvec3 place(double u, double v) const {
        const glm::dvec2 where = at(texcoords, u, v) * glm::dvec2(material.displacement_map.scale) +
                                 glm::dvec2(material.displacement_map.offset);
        const double height = double{material.displacement_scale} *
                              (lookup(texture, where, 0) - double{material.displacement_midlevel});
        return at(points, u, v) + height * flat_normal();
    }
    /// By differences over a texel or so.
    dvec3 normal(double u, double v) const {
        constexpr double step = 0.01;
        return glm::normalize(
            glm::cross(place(u + step, v) - place(u - step, v), place(u, v + step) - place(u, v - step)));
    }
    void cut(int parts, Body& body) const {
        for (int j = 0; j < parts; ++j)
            for (int i = 0; i < parts; ++i) {
                const double u = double(i) / parts, v = double(j) / parts, step = 1.0 / parts;
                for (const bool upper : {false, true}) {
                    const glm::dvec2 b = upper ? glm::dvec2(u + step, v + step) : glm::dvec2(u + step, v);
                    const glm::dvec2 c = upper ? glm::dvec2(u, v + step) : glm::dvec2(u + step, v + step);
                    Facet f{place(u, v),
                            place(b.x, b.y) - place(u, v),
                            place(c.x, c.y) - place(u, v),
                            {},
                            &material};
                    f.normal = glm::normalize(glm::cross(f.e1, f.e2));
                    f.smooth_a = normal(u, v);
                    f.smooth_e1 = normal(b.x, b.y) - f.smooth_a;
                    f.smooth_e2 = normal(c.x, c.y) - f.smooth_a;
                    body.add(f);
                }
            }
    }
};

constexpr int parts = 24; // of a displaced face, both ways

DisplacedQuad displaced(const Scene& scene, const Mesh& mesh, std::size_t first, const Material& material) {
    DisplacedQuad quad{
        {}, {}, material, scene.textures[static_cast<std::size_t>(material.displacement_map.texture)]};
    for (std::size_t k = 0; k < 4; ++k) {
        quad.points[k] = mesh.points[static_cast<std::size_t>(mesh.face_vertices[first + k])];
        quad.texcoords[k] = mesh.texcoords[static_cast<std::size_t>(mesh.face_texcoords[first + k])];
    }
    return quad;
}

} // namespace

void Body::add(const Facet& f) {
    for (const dvec3& p : {f.a, f.a + f.e1, f.a + f.e2}) {
        low = glm::min(low, p - 1e-9);
        high = glm::max(high, p + 1e-9);
    }
    facets.push_back(f);
}

bool Body::may_meet(const dvec3& o, const dvec3& d) const {
    double begin = 0, end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (low[axis] - o[axis]) / d[axis], b = (high[axis] - o[axis]) / d[axis];
        if (std::isnan(a) || std::isnan(b)) // along the box's side
            continue;
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end;
}

bool meet(const Facet& f, const dvec3& o, const dvec3& d, Meeting& m) {
    const dvec3 p = glm::cross(d, f.e2), s = o - f.a, q = glm::cross(s, f.e1);
    const double det = glm::dot(f.e1, p);
    if (det == 0)
        return false;
    const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, t = glm::dot(f.e2, q) / det;
    const bool one_sided = !f.material->two_sided && f.material->transmission == 0;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 1e-7 && t < m.t) || (one_sided && glm::dot(f.normal, d) > 0))
        return false;
    m = {t, u, v, &f};
    return true;
}

std::vector<Body> plain_bodies(const Scene& scene) {
    std::vector<Body> bodies;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        Body& body = bodies.emplace_back();
        std::size_t first = 0;
        for (const int size : mesh.face_sizes) {
            if (is_displaced(material)) {
                displaced(scene, mesh, first, material).cut(parts, body);
                first += static_cast<std::size_t>(size);
                continue;
            }
            const auto corner = [&](int k) {
                return mesh.points[static_cast<std::size_t>(
                    mesh.face_vertices[first + static_cast<std::size_t>(k)])];
            };
            for (int k = 1; k + 1 < size; ++k) {
                Facet f{corner(0), corner(k) - corner(0), corner(k + 1) - corner(0), {}, nullptr};
                f.normal = glm::normalize(glm::cross(f.e1, f.e2));
                f.material = &material;
                body.add(f);
            }
            first += static_cast<std::size_t>(size);
        }
    }
    return bodies;
}

} // namespace razor::test
