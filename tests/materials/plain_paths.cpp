#include "tests/materials/plain_paths.h"

#include "tests/materials/plain_bodies.h"
#include "tests/materials/plain_pattern.h"
#include "tests/materials/plain_surface.h"
#include "tests/materials/skies.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

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
                    lamps_.push_back(&f);
    }

    double next() { return static_cast<double>(random_()) / 4294967296.0; }

    /// `n`: bounces before. `diffuse`: the last one went in all directions.
    dvec3 radiance(const dvec3& o, const dvec3& d, int n, bool diffuse) {
        Meeting m;
        for (const Body& body : bodies_)
            if (body.may_meet(o, d))
                for (const Facet& f : body.facets)
                    meet(f, o, d, m);
        dvec3 sum(0);
        if (n > 0 && !diffuse)
            for (const Light& light : scene_.lights)
                sum += met_light(light, o, d, m.t);
        if (m.facet == nullptr)
            return diffuse ? sum : sum + sky_radiance(scene_, d);
        const bool sampled = m.facet->material->light && diffuse;
        const dvec3 emitted = sampled ? dvec3(0) : dvec3(m.facet->material->emission);
        return sum + emitted + reflected(m, o + m.t * d, -d, n);
    }

private:
    bool open(const dvec3& o, const dvec3& d, double end) const {
        Meeting m;
        m.t = end * (1 - 1e-9);
        return std::none_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
            return body.may_meet(o, d) && std::any_of(body.facets.begin(), body.facets.end(),
                                                      [&](const Facet& f) { return meet(f, o, d, m); });
        });
    }

    dvec3 pattern_at(const TextureMap& map, const dvec3& p) const {
        const Pattern& pattern = *scene_.textures[static_cast<std::size_t>(map.texture)].pattern;
        const double x = plain_value(pattern, p / pattern.size);
        return dvec3(pattern.low) + x * (dvec3(pattern.high) - dvec3(pattern.low));
    }
    /// With what maps say at this point.
    Material material_at(const Facet& facet, const dvec3& p) const {
        Material m = *facet.material;
        if (m.albedo_map.texture >= 0)
            m.albedo *= glm::vec3(pattern_at(m.albedo_map, p));
        if (m.roughness_map.texture >= 0)
            m.roughness *= static_cast<float>(pattern_at(m.roughness_map, p).y);
        return m;
    }
    /// Of the front; bent as Blinn has it (1978): by the slopes of heights along the surface.
    dvec3 normal_at(const Meeting& m, const dvec3& p) const {
        const Facet& f = *m.facet;
        const dvec3 n = f.smooth_a == dvec3(0)
                            ? f.normal
                            : glm::normalize(f.smooth_a + m.u * f.smooth_e1 + m.v * f.smooth_e2);
        const TextureMap& map = f.material->bump_map;
        if (map.texture < 0)
            return n;
        const Frame3 frame(n);
        const auto height = [&](const dvec3& at) {
            return double{f.material->bump} * glm::dot(pattern_at(map, at), dvec3(0.2126, 0.7152, 0.0722));
        };
        constexpr double step = 1e-4;
        const auto slope = [&](const dvec3& way) {
            return (height(p + step * way) - height(p - step * way)) / (2 * step);
        };
        return glm::normalize(n - slope(frame.x) * frame.x - slope(frame.y) * frame.y);
    }
    static dvec3 met_light(const Light& l, const dvec3& o, const dvec3& d, double end) {
        const dvec3 n = glm::cross(l.edge_u, l.edge_v);
        const double facing = -glm::dot(n, d);
        if (facing <= 0)
            return dvec3(0);
        const double t = glm::dot(n, o - l.corner) / facing;
        const dvec3 p = o + t * d - l.corner;
        const double u = glm::dot(glm::cross(p, l.edge_v), n) / glm::dot(n, n);
        const double v = glm::dot(glm::cross(l.edge_u, p), n) / glm::dot(n, n);
        const bool within = t > 0 && t < end && u >= 0 && u <= 1 && v >= 0 && v <= 1;
        return within ? dvec3(l.radiance) : dvec3(0);
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
        const auto reflectance = [&](const dvec3& l) {
            return glossy ? all.reflectance(v, l) : all.scattered(v, l);
        };
        dvec3 sum(0);
        for (const Light& light : scene_.lights) {
            const dvec3 n = glm::cross(light.edge_u, light.edge_v);
            const double s = next(), t = next();
            const dvec3 way = light.corner + s * light.edge_u + t * light.edge_v - p;
            const double away = glm::length(way);
            const dvec3 d = way / away, l = frame.in(d);
            const double facing = -glm::dot(n, d);
            if (lit(l, d) && facing > 0 && open(p, d, away))
                sum += reflectance(l) * dvec3(light.radiance) * (l.z * facing / (away * away));
        }
        for (const Facet* lamp : lamps_) {
            const Facet& f = *lamp;
            const double root = std::sqrt(next()), part = next();
            const dvec3 way = f.a + root * (1 - part) * f.e1 + root * part * f.e2 - p;
            const double away = glm::length(way), area = glm::length(glm::cross(f.e1, f.e2)) / 2;
            const dvec3 d = way / away, l = frame.in(d);
            const double way_out = -glm::dot(f.normal, d);
            const double facing = f.material->two_sided ? std::abs(way_out) : way_out;
            if (lit(l, d) && facing > 0 && open(p, d, away * (1 - 1e-6)))
                sum += reflectance(l) * dvec3(f.material->emission) * (l.z * facing * area / (away * away));
        }
        if (largest(dvec3(scene_.sky)) > 0) {
            const dvec3 l = cosine_direction();
            const dvec3 seen = scene_.sky_map.texture >= 0 ? reflectance(l) : all.scattered(v, l);
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
    dvec3 about_normal(const dvec3& v, double alpha) {
        const double x = next(), phi = 2 * pi * next();
        const double tan = alpha * std::sqrt(x / (1 - x)), z = 1 / std::sqrt(1 + tan * tan);
        const dvec3 h(tan * z * std::cos(phi), tan * z * std::sin(phi), z);
        return 2 * glm::dot(v, h) * h - v;
    }

    struct Branch {
        double weight = 0; // by which it is chosen
        dvec3 direction{0, 0, 1}, factor{0};
        bool diffuse = false;
    };

    /// What a smooth base reflects and lets through.
    static void add_smooth_base(const Material& m, const PlainSurface& plain, const dvec3& v, double beneath,
                                bool inside, std::vector<Branch>& branches) {
        const double through = m.transmission * (1.0 - m.metallic), ior = m.ior;
        const double eta = inside ? ior : 1 / ior, sine_square = eta * eta * (1 - v.z * v.z);
        const double cosine = std::sqrt(std::max(1 - sine_square, 0.0)); // beyond
        dvec3 reflected = plain.base_fresnel(v.z);
        double lost = reflected.x; // of a dielectric
        if (through > 0 && inside) {
            const double f0 = std::pow((ior - 1) / (ior + 1), 2);
            lost = m.specular * (f0 + (1 - f0) * PlainSurface::schlick(cosine));
            reflected = dvec3(lost);
        }
        branches.push_back({0, {-v.x, -v.y, v.z}, beneath * plain.below_sheen(v.z, v.z) * reflected});
        if (through > 0 && sine_square < 1)
            branches.push_back({0,
                                {-eta * v.x, -eta * v.y, -cosine},
                                beneath * plain.below_sheen(v.z, cosine) * through * (1 - lost) * eta * eta *
                                    dvec3(m.albedo)});
    }

    dvec3 reflected(const Meeting& met, const dvec3& p, const dvec3& toward, int n) {
        const Facet& facet = *met.facet;
        const Material m = material_at(facet, p);
        const bool inside = glm::dot(facet.normal, toward) < 0;
        const dvec3 shading = normal_at(met, p), front = inside ? -facet.normal : facet.normal;
        const Frame3 frame(inside ? -shading : shading);
        dvec3 v = frame.in(toward);
        v.z = std::max(v.z, 1e-4); // slopes of bumps that face away are seen as at grazing
        const PlainSurface all(m);
        const bool last = n == scene_.settings.bounces;
        const dvec3 sum = direct(frame, front, all, p, v, last);
        if (last)
            return sum;
        const double alpha = width(m.roughness), coat_alpha = width(m.coat_roughness);
        const double beneath = 1 - all.coat_fresnel(v.z);
        std::vector<Branch> branches;
        const bool shiny = m.metallic > 0 || m.specular > 0 || m.transmission > 0;
        if (shiny && alpha < smooth)
            add_smooth_base(m, all, v, beneath, inside, branches);
        if (m.coat > 0 && coat_alpha < smooth)
            branches.push_back({0, {-v.x, -v.y, v.z}, dvec3(all.coat_fresnel(v.z))});
        std::vector<double> widths;
        if (shiny && alpha >= smooth)
            widths.push_back(alpha);
        if (m.coat > 0 && coat_alpha >= smooth)
            widths.push_back(coat_alpha);
        if (!widths.empty()) {
            Branch b;
            b.direction =
                about_normal(v, widths[std::min(static_cast<std::size_t>(next() * double(widths.size())),
                                                widths.size() - 1)]);
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
    std::vector<const Facet*> lamps_;
    std::mt19937 random_{4711};
};

} // namespace

std::vector<BlockSums> plain_picture(const Scene& scene, int side, int samples_a_pixel) {
    Tracer tracer(scene);
    const Camera& camera = scene.camera;
    const Settings& s = scene.settings;
    const dvec3 forward = glm::normalize(camera.target - camera.position);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const double high = std::tan(glm::radians(camera.fov_degrees) / 2), wide = high * s.width / s.height;
    std::vector<BlockSums> blocks(static_cast<std::size_t>((s.width / side) * (s.height / side)));
    for (int row = 0; row < s.height; ++row)
        for (int column = 0; column < s.width; ++column) {
            BlockSums& b = blocks[static_cast<std::size_t>(row / side * (s.width / side) + column / side)];
            for (int k = 0; k < samples_a_pixel; ++k, ++b.samples) {
                const double x = (column + tracer.next()) / s.width * 2 - 1;
                const double y = 1 - (row + tracer.next()) / s.height * 2;
                const dvec3 d = glm::normalize(forward + x * wide * right + y * high * up);
                const dvec3 seen = tracer.radiance(camera.position, d, 0, false);
                b.sum += seen;
                b.squares += seen * seen;
            }
        }
    return blocks;
}

} // namespace razor::test
