#include "tests/materials/plain_bodies.h"

#include "tests/displacement/heights.h"
#include "tests/materials/plain_cage.h"
#include "tests/materials/plain_textures.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

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
                    f.uv_a = at(texcoords, u, v);
                    f.uv_e1 = at(texcoords, b.x, b.y) - f.uv_a;
                    f.uv_e2 = at(texcoords, c.x, c.y) - f.uv_a;
                    body.add(f);
                }
            }
    }
};

constexpr int parts = 24; // of a displaced face, both ways
constexpr int divisions = 4;

std::size_t at(int n) {
    return static_cast<std::size_t>(n);
}

/// A mesh in its object's own units: bodies of faces that lie together.
class Cutter {
public:
    Cutter(const Scene& scene, const Mesh& mesh, int material) : scene_(scene), mesh_(mesh), all_(material) {}

    std::vector<Body> bodies() const {
        if (mesh_.scheme == Scheme::catmull_clark)
            return subdivided();
        Body body;
        std::size_t first = 0;
        for (std::size_t f = 0; f < mesh_.face_sizes.size(); ++f) {
            add_flat(f, first, body);
            first += at(mesh_.face_sizes[f]);
        }
        return {body};
    }

private:
    const Material& material_of(std::size_t face) const {
        const int own = mesh_.face_materials.empty() ? mesh_.material : mesh_.face_materials[face];
        return scene_.materials[at(all_ >= 0 ? all_ : own)];
    }
    Facet facet(const Material& m, const dvec3& a, const dvec3& b, const dvec3& c) const {
        Facet f{a, b - a, c - a, glm::normalize(glm::cross(b - a, c - a)), &m};
        if (m.alpha_cutoff > 0 && m.albedo_map.texture >= 0)
            f.holes = &scene_.textures[at(m.albedo_map.texture)];
        return f;
    }
    void add_flat(std::size_t face, std::size_t first, Body& body) const {
        const Material& material = material_of(face);
        const auto point = [&](int k) { return mesh_.points[at(mesh_.face_vertices[first + at(k)])]; };
        const auto texcoord = [&](int k) {
            return glm::dvec2(mesh_.texcoords[at(mesh_.face_texcoords[first + at(k)])]);
        };
        if (is_displaced(material)) {
            DisplacedQuad quad{{}, {}, material, scene_.textures[at(material.displacement_map.texture)]};
            for (int k = 0; k < 4; ++k) {
                quad.points[at(k)] = point(k);
                quad.texcoords[at(k)] = texcoord(k);
            }
            quad.cut(parts, body);
            return;
        }
        for (int k = 1; k + 1 < mesh_.face_sizes[face]; ++k) {
            Facet f = facet(material, point(0), point(k), point(k + 1));
            if (!mesh_.face_texcoords.empty()) {
                f.uv_a = texcoord(0);
                f.uv_e1 = texcoord(k) - f.uv_a;
                f.uv_e2 = texcoord(k + 1) - f.uv_a;
            }
            body.add(f);
        }
    }
    std::vector<Body> subdivided() const {
        const PlainQuads quads = plain_limit(mesh_, divisions);
        const auto point = [&](int v) { return quads.points[at(v)]; };
        std::vector<Body> bodies;
        std::size_t quad = 0;
        for (std::size_t f = 0; f < mesh_.face_sizes.size(); ++f)
            for (int corner = 0; corner < mesh_.face_sizes[f]; ++corner) {
                Body& body = bodies.emplace_back();
                for (std::size_t end = quad + (std::size_t{1} << (2 * (divisions - 1))); quad < end; ++quad) {
                    const auto& corners = quads.faces[quad];
                    const auto& normals = quads.normals[quad];
                    const auto& texcoords = quads.texcoords[quad];
                    for (const std::size_t k : {1U, 2U}) {
                        Facet part = facet(material_of(f), point(corners[0]), point(corners[k]),
                                           point(corners[k + 1]));
                        part.smooth_a = normals[0];
                        part.smooth_e1 = normals[k] - normals[0];
                        part.smooth_e2 = normals[k + 1] - normals[0];
                        part.uv_a = texcoords[0];
                        part.uv_e1 = texcoords[k] - texcoords[0];
                        part.uv_e2 = texcoords[k + 1] - texcoords[0];
                        body.add(part);
                    }
                }
            }
        return bodies;
    }

    const Scene& scene_;
    const Mesh& mesh_;
    int all_; // the material that stands for all others; -1: none
};

/// As it stands where it is drawn: fronts stay fronts.
Body placed(const Body& body, const Affine& to_world) {
    Body out;
    out.to_object = inverse(to_world);
    const double size = glm::determinant(to_world.linear);
    out.scale = std::cbrt(std::abs(size));
    const glm::dmat3 of_normals = glm::transpose(out.to_object.linear);
    for (Facet f : body.facets) {
        f.a = to_world(f.a);
        f.e1 = to_world.linear * f.e1;
        f.e2 = to_world.linear * f.e2;
        f.normal = glm::normalize(of_normals * f.normal);
        if (f.smooth_a != dvec3(0)) {
            const auto turned = [&](const dvec3& n) { return glm::normalize(of_normals * n); };
            const dvec3 a = turned(f.smooth_a);
            f.smooth_e1 = turned(f.smooth_a + f.smooth_e1) - a;
            f.smooth_e2 = turned(f.smooth_a + f.smooth_e2) - a;
            f.smooth_a = a;
        }
        out.add(f);
    }
    return out;
}

void draw(const Scene& scene, std::size_t group, const Affine& above, int material,
          std::vector<Body>& bodies) {
    for (const Placement& p : scene.graph.groups[group].placements) {
        const int stated = p.material >= 0 ? p.material : material;
        for (int copy = 0; copy < p.copies.x * p.copies.y * p.copies.z; ++copy) {
            const glm::ivec3 step(copy % p.copies.x, copy / p.copies.x % p.copies.y,
                                  copy / (p.copies.x * p.copies.y));
            Affine local = to_affine(p.local);
            local.translation += dvec3(step) * p.spacing;
            const Affine to_world = above * local;
            if (p.group >= 0)
                draw(scene, at(p.group), to_world, stated, bodies);
            else
                for (const Body& body : Cutter(scene, scene.meshes[at(p.mesh)], stated).bodies())
                    bodies.push_back(placed(body, to_world));
        }
    }
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

bool meet(const Body& body, const Facet& f, const dvec3& o, const dvec3& d, Meeting& m) {
    const dvec3 p = glm::cross(d, f.e2), s = o - f.a, q = glm::cross(s, f.e1);
    const double det = glm::dot(f.e1, p);
    if (det == 0)
        return false;
    const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, t = glm::dot(f.e2, q) / det;
    const bool one_sided = !f.material->two_sided && f.material->transmission == 0;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 1e-7 && t < m.t) || (one_sided && glm::dot(f.normal, d) > 0))
        return false;
    if (f.holes != nullptr &&
        plain_opacity(*f.holes, f.material->albedo_map, f.uv_a + u * f.uv_e1 + v * f.uv_e2) <
            double{f.material->alpha_cutoff})
        return false;
    m = {t, u, v, &f, &body};
    return true;
}

std::vector<Body> plain_bodies(const Scene& scene) {
    std::vector<Body> bodies;
    if (scene.graph.groups.empty())
        for (const Mesh& mesh : scene.meshes)
            for (Body& body : Cutter(scene, mesh, -1).bodies())
                bodies.push_back(std::move(body));
    else
        draw(scene, 0, {}, -1, bodies);
    return bodies;
}

} // namespace razor::test
