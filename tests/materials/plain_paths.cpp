#include "tests/materials/plain_paths.h"

#include "tests/materials/plain_bodies.h"
#include "tests/materials/plain_camera.h"
#include "tests/materials/plain_filter.h"
#include "tests/materials/plain_lights.h"
#include "tests/materials/plain_surface.h"
#include "tests/materials/plain_textures.h"
#include "tests/materials/skies.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double smooth = 1e-3; // widths below are of mirrors

/// The normal and two directions across it.
struct Frame3 {
    dvec3 x, y, z;
    explicit Frame3(const dvec3& normal) : z(normal) {
        x = glm::normalize(glm::cross(std::abs(z.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), z));
        y = glm::cross(z, x);
    }
    dvec3 in(const dvec3& w) const { return {glm::dot(x, w), glm::dot(y, w), glm::dot(z, w)}; }
    dvec3 out(const dvec3& l) const { return l.x * x + l.y * y + l.z * z; }
};

double width(float roughness) {
    return double{roughness} * roughness;
}

double largest(const dvec3& c) {
    return std::max({c.x, c.y, c.z});
}

class Tracer {
public:
    explicit Tracer(const Scene& scene) : scene_(scene), bodies_(plain_bodies(scene)) {
        for (const Body& body : bodies_)
            for (const Facet& f : body.facets)
                if (f.material->light)
                    lamps_.push_back({&f, &body});
    }

    double next() { return static_cast<double>(random_()) / 4294967296.0; }

    /// `n`: bounces before. `diffuse`: the last one went in all directions.
    dvec3 radiance(const dvec3& o, const dvec3& d, int n, bool diffuse) {
        Meeting m;
        for (const Body& body : bodies_)
            if (body.may_meet(o, d))
                for (const Facet& f : body.facets)
                    meet(body, f, o, d, m);
        dvec3 sum(0);
        if (n > 0 && !diffuse)
            for (const Light& light : scene_.lights)
                sum += met_light(light, o, d, m.t);
        if (m.facet == nullptr)
            return diffuse ? sum : sum + sky_radiance(scene_, d);
        const bool sampled = m.facet->material->light && diffuse;
        const dvec3 p = o + m.t * d;
        const dvec3 emitted = sampled ? dvec3(0) : emission(*m.facet, place_of(m, p));
        return sum + emitted + reflected(m, p, -d, n);
    }

private:
    bool open(const dvec3& o, const dvec3& d, double end) const {
        Meeting m;
        m.t = end * (1 - 1e-9);
        return std::none_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
            return body.may_meet(o, d) && std::any_of(body.facets.begin(), body.facets.end(),
                                                      [&](const Facet& f) { return meet(body, f, o, d, m); });
        });
    }

    static PlainPlace place_of(const Meeting& m, const dvec3& p) {
        return {m.body->to_object(p), m.facet->uv_a + m.u * m.facet->uv_e1 + m.v * m.facet->uv_e2};
    }
    dvec3 emission(const Facet& facet, const PlainPlace& at) const {
        return dvec3(facet.material->emission) * plain_colour(scene_, facet.material->emission_map, at);
    }
    /// With what maps say at this point.
    Material material_at(const Facet& facet, const PlainPlace& at) const {
        Material m = *facet.material;
        m.albedo *= glm::vec3(plain_colour(scene_, m.albedo_map, at));
        m.metallic *= static_cast<float>(plain_colour(scene_, m.metallic_map, at).z);
        m.roughness *= static_cast<float>(plain_colour(scene_, m.roughness_map, at).y);
        m.sheen *= glm::vec3(plain_colour(scene_, m.sheen_map, at));
        m.sheen_roughness *= static_cast<float>(plain_sheen_roughness(scene_, m.sheen_roughness_map, at));
        return m;
    }
    /// How points of the facet move with texture coordinates: their gradients, across it none.
    static std::array<dvec3, 2> along_texture(const Facet& f) {
        const double across = f.uv_e1.x * f.uv_e2.y - f.uv_e2.x * f.uv_e1.y;
        return {(f.uv_e2.y * f.e1 - f.uv_e1.y * f.e2) / across,
                (f.uv_e1.x * f.e2 - f.uv_e2.x * f.e1) / across};
    }
    /// As normal maps are defined (glTF 2.0, section 3.9.3): against tangents and the normal.
    dvec3 by_normal_map(const Meeting& m, const dvec3& n, const PlainPlace& at) const {
        const Facet& f = *m.facet;
        if (f.material->normal_map.texture < 0)
            return n;
        const auto [along_u, along_v] = along_texture(f);
        const dvec3 tilt = 2.0 * plain_colour(scene_, f.material->normal_map, at) - 1.0;
        const dvec3 tangent = glm::normalize(along_u - glm::dot(n, along_u) * n);
        dvec3 bitangent = glm::cross(n, tangent);
        if (glm::dot(bitangent, along_v) < 0)
            bitangent = -bitangent;
        const double scale = f.material->normal_scale;
        return glm::normalize(scale * tilt.x * tangent + scale * tilt.y * bitangent + tilt.z * n);
    }
    /// Bent as Blinn has it (1978): by the slopes of heights along the surface.
    dvec3 by_bumps(const Meeting& m, const dvec3& n, const dvec3& p) const {
        const Facet& f = *m.facet;
        const TextureMap& map = f.material->bump_map;
        if (map.texture < 0)
            return n;
        const Frame3 frame(n);
        const bool textured = f.uv_e1 != glm::dvec2(0) || f.uv_e2 != glm::dvec2(0);
        const auto height = [&](const dvec3& way) {
            PlainPlace at = place_of(m, p + way);
            if (textured) { // the gradient of each of both vanishes where the other goes
                const auto [along_u, along_v] = along_texture(f);
                const dvec3 u = glm::cross(along_v, f.normal), v = glm::cross(f.normal, along_u);
                at.texcoords += glm::dvec2(glm::dot(way, u) / glm::dot(along_u, u),
                                           glm::dot(way, v) / glm::dot(along_v, v));
            }
            return m.body->scale * double{f.material->bump} *
                   glm::dot(plain_colour(scene_, map, at), dvec3(0.2126, 0.7152, 0.0722));
        };
        constexpr double step = 1e-4;
        const auto slope = [&](const dvec3& way) {
            return (height(step * way) - height(-step * way)) / (2 * step);
        };
        return glm::normalize(n - slope(frame.x) * frame.x - slope(frame.y) * frame.y);
    }
    /// Of the front.
    dvec3 normal_at(const Meeting& m, const dvec3& p) const {
        const Facet& f = *m.facet;
        const dvec3 n = f.smooth_a == dvec3(0)
                            ? f.normal
                            : glm::normalize(f.smooth_a + m.u * f.smooth_e1 + m.v * f.smooth_e2);
        return by_bumps(m, by_normal_map(m, n, place_of(m, p)), p);
    }

    /// Into the hemisphere, by its cosine.
    dvec3 cosine_direction() {
        const double r = std::sqrt(next()), phi = 2 * pi * next();
        return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - r * r, 0.0))};
    }

    /// Light of lights and, in all directions, of the sky. `glossy`: what rough lobes reflect of lights too.
    /// `front`: the geometric normal on the viewer's side, which light comes from.
    dvec3 direct(const Frame3& frame, const dvec3& front, const PlainSurface& all, const dvec3& p,
                 const dvec3& v, bool glossy) {
        const auto lit = [&](const dvec3& l, const dvec3& d) { return l.z > 0 && glm::dot(front, d) > 0; };
        const auto reflectance = [&](const dvec3& l, bool whole) {
            return whole ? all.reflectance(v, l) : all.scattered(v, l);
        };
        dvec3 sum(0);
        for (const Light& light : scene_.lights) {
            const double choice = next();
            const PlainLight to = choose_of_light(light, p, choice, next());
            const dvec3 l = frame.in(to.direction);
            // No ray of a lobe finds what has no size.
            if (lit(l, to.direction) && largest(to.irradiance) > 0 && open(p, to.direction, to.away))
                sum += reflectance(l, glossy || is_delta(light)) * to.irradiance * l.z;
        }
        for (const auto& [lamp, body] : lamps_) {
            const Facet& f = *lamp;
            const double root = std::sqrt(next()), part = next();
            const double s = root * (1 - part), t = root * part;
            const dvec3 way = f.a + s * f.e1 + t * f.e2 - p;
            const double away = glm::length(way), area = glm::length(glm::cross(f.e1, f.e2)) / 2;
            const dvec3 d = way / away, l = frame.in(d);
            const double way_out = -glm::dot(f.normal, d);
            const double facing = f.material->two_sided ? std::abs(way_out) : way_out;
            if (lit(l, d) && facing > 0 && open(p, d, away * (1 - 1e-6)))
                sum += reflectance(l, glossy) * emission(f, place_of({away, s, t, lamp, body}, p + way)) *
                       (l.z * facing * area / (away * away));
        }
        if (largest(dvec3(scene_.sky)) > 0) {
            const dvec3 l = cosine_direction();
            const dvec3 seen = scene_.sky_map.texture >= 0 ? reflectance(l, glossy) : all.scattered(v, l);
            if (lit(l, frame.out(l)) && open(p, frame.out(l), std::numeric_limits<double>::infinity()))
                sum += seen * sky_radiance(scene_, frame.out(l)) * pi;
        }
        return sum;
    }

    /// Density of directions l that rough lobes of that width send v to, by normals of density D cos.
    static double density(const dvec3& v, const dvec3& l, double alpha) {
        const dvec3 h = glm::normalize(v + l);
        const double t = h.z * h.z * (alpha * alpha - 1) + 1;
        return alpha * alpha / (pi * t * t) * h.z / (4 * glm::dot(v, h));
    }
    /// A normal of density D cos.
    dvec3 normal_of(double alpha) {
        const double x = next(), phi = 2 * pi * next();
        const double tan = alpha * std::sqrt(x / (1 - x)), z = 1 / std::sqrt(1 + tan * tan);
        return {tan * z * std::cos(phi), tan * z * std::sin(phi), z};
    }

    struct Branch {
        double weight = 0; // by which it is chosen
        dvec3 direction{0, 0, 1}, factor{0};
        bool diffuse = false;
    };

    dvec3 reflected(const Meeting& met, const dvec3& p, const dvec3& toward, int n) {
        const Facet& facet = *met.facet;
        const Material m = material_at(facet, place_of(met, p));
        const bool inside = glm::dot(facet.normal, toward) < 0;
        const dvec3 shading = normal_at(met, p), front = inside ? -facet.normal : facet.normal;
        const Frame3 frame(inside ? -shading : shading);
        dvec3 v = frame.in(toward);
        v.z = std::max(v.z, 1e-4); // slopes of bumps that face away are seen as at grazing
        const PlainSurface all(m, inside);
        const bool last = n == scene_.settings.bounces;
        const dvec3 sum = direct(frame, front, all, p, v, last);
        if (last)
            return sum;
        const double alpha = width(m.roughness), coat_alpha = width(m.coat_roughness);
        const double beneath = 1 - all.coat_fresnel(v.z);
        std::vector<Branch> branches;
        const bool shiny = m.metallic > 0 || m.specular > 0 || m.transmission > 0;
        if (shiny && alpha < smooth)
            branches.push_back(
                {0, {-v.x, -v.y, v.z}, beneath * all.below_sheen(v.z, v.z) * all.base_fresnel(v.z)});
        if (m.coat > 0 && coat_alpha < smooth)
            branches.push_back({0, {-v.x, -v.y, v.z}, dvec3(all.coat_fresnel(v.z))});
        std::vector<double> widths;
        if (shiny && alpha >= smooth)
            widths.push_back(alpha);
        if (m.coat > 0 && coat_alpha >= smooth)
            widths.push_back(coat_alpha);
        if (!widths.empty()) {
            Branch b;
            const auto chosen = static_cast<std::size_t>(next() * double(widths.size()));
            const dvec3 h = normal_of(widths[std::min(chosen, widths.size() - 1)]);
            b.direction = 2 * glm::dot(v, h) * h - v;
            if (b.direction.z > 0) {
                double sum_of = 0;
                for (const double w : widths)
                    sum_of += density(v, b.direction, w) / double(widths.size());
                b.factor = all.rough(v, b.direction) * (b.direction.z / sum_of);
            }
            // Not by this one direction: the choice must not depend on it.
            b.weight = largest(all.base_fresnel(v.z)) + all.coat_fresnel(v.z) + 0.1;
            branches.push_back(b);
        }
        if (all.let_through() > 0) {
            const dvec3 h = alpha < smooth ? dvec3(0, 0, 1) : normal_of(alpha);
            Branch b;
            b.factor = all.through(v, h, b.direction);
            b.weight = all.let_through() * largest(dvec3(m.albedo));
            branches.push_back(b);
        }
        const double scattered = (1.0 - m.metallic) * (1.0 - m.transmission);
        if (n < scene_.settings.diffuse_bounces && (scattered > 0 || has_sheen(m))) {
            Branch b;
            b.direction = cosine_direction();
            b.factor = all.scattered(v, b.direction) * pi;
            b.weight = scattered * largest(dvec3(m.albedo)) + largest(dvec3(m.sheen));
            b.diffuse = true;
            branches.push_back(b);
        }
        double weights = 0;
        for (Branch& b : branches) {
            if (b.weight == 0)
                b.weight = largest(b.factor);
            weights += b.weight;
        }
        double choice = next() * weights;
        for (const Branch& b : branches) {
            choice -= b.weight;
            if (choice >= 0)
                continue;
            if (largest(b.factor) <= 0)
                return sum;
            const dvec3 d = glm::normalize(frame.out(b.direction));
            if ((b.direction.z > 0) != (glm::dot(front, d) > 0))
                return sum; // into the surface that a bump only bends
            return sum + b.factor * (weights / b.weight) * radiance(p, d, n + 1, b.diffuse);
        }
        return sum;
    }

    const Scene& scene_;
    std::vector<Body> bodies_;
    std::vector<std::pair<const Facet*, const Body*>> lamps_;
    std::mt19937 random_{4711};
};

} // namespace

std::vector<BlockMean> plain_picture(const Scene& scene, int side, int samples_a_pixel) {
    Tracer tracer(scene);
    const Settings& s = scene.settings;
    const double shape = double(s.width) / s.height;
    const PlainFilter filter(s.filter);
    const std::function<double()> next = [&] { return tracer.next(); };
    std::vector<BlockMean> blocks(static_cast<std::size_t>((s.width / side) * (s.height / side)));
    for (int row = 0; row < s.height; ++row)
        for (int column = 0; column < s.width; ++column) {
            BlockMean& b = blocks[static_cast<std::size_t>(row / side * (s.width / side) + column / side)];
            SampleSums pixel;
            for (int k = 0; k < samples_a_pixel; ++k) {
                const FilmSample on_film = filter.choose(next);
                const double x = (column + 0.5 + on_film.place.x) / s.width * 2 - 1;
                const double y = 1 - (row + 0.5 + on_film.place.y) / s.height * 2;
                glm::dvec2 lens(0);
                if (has_lens(scene.camera)) {
                    lens.x = tracer.next();
                    lens.y = tracer.next();
                }
                const PlainRay ray = plain_camera_ray(scene.camera, shape, {x, y}, lens);
                pixel.add(on_film.factor * tracer.radiance(ray.origin, ray.direction, 0, false));
            }
            const double share = 1.0 / (side * side);
            b.mean += share * pixel.mean();
            b.variance += share * share * pixel.variance();
        }
    return blocks;
}

} // namespace razor::test
