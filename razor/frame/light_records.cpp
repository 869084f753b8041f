#include "razor/frame/light_records.h"

#include "razor/frame/unit_vector.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// Any two unit vectors that make a right-handed system with the unit vector `n`: u, v, n.
void span_plane(const dvec3& n, dvec3& u, dvec3& v) {
    const dvec3 a = glm::abs(n);
    const dvec3 other = a.x <= a.y && a.x <= a.z ? dvec3(1, 0, 0)
                        : a.y <= a.z             ? dvec3(0, 1, 0)
                                                 : dvec3(0, 0, 1);
    u = glm::normalize(glm::cross(other, n));
    v = glm::cross(n, u);
}

/// 1 - cos, exact also for small angles.
double versine(double angle) {
    const double half = std::sin(angle / 2);
    return 2 * half * half;
}

/// Fills all but radiance and spacing. `domain`: what samples are spread over, an area or a solid angle;
/// `factor`: of the radiance, see LightRecord, without pi and samples.
void fill_shape(const Light& light, const dvec3& origin, LightRecord& r, double& domain, double& factor) {
    put(r.corner, light.position - origin);
    factor = 1;
    switch (light.kind) {
    case LightKind::rectangle: {
        const dvec3 normal = glm::cross(light.edge_u, light.edge_v);
        domain = factor = glm::length(normal);
        r.shape = light_rectangle;
        put(r.corner, light.corner - origin);
        put(r.edge_u, light.edge_u);
        put(r.edge_v, light.edge_v);
        put(r.normal, normal / factor);
        break;
    }
    case LightKind::disk: {
        const dvec3 normal = unit_vector(light.direction);
        dvec3 u, v;
        span_plane(normal, u, v);
        domain = factor = pi * light.radius * light.radius;
        r.shape = light_disk;
        put(r.edge_u, u * light.radius);
        put(r.edge_v, v * light.radius);
        put(r.normal, normal);
        break;
    }
    case LightKind::sphere:
        domain = pi * light.radius * light.radius; // what is seen of it from afar
        factor = 2 * pi;
        r.shape = light_sphere;
        r.radius = static_cast<float>(light.radius);
        break;
    case LightKind::point:
        r.shape = light_point;
        r.cone_end = 4; // all directions are within
        r.cone_scale = 1;
        break;
    case LightKind::spot: {
        const double end = versine(glm::radians(light.cone_angle));
        const double whole = versine(glm::radians(light.cone_angle - light.cone_delta));
        r.shape = light_point;
        put(r.normal, unit_vector(light.direction));
        r.cone_end = static_cast<float>(end);
        r.cone_scale = static_cast<float>(1 / std::max(end - whole, 1e-6 * end)); // a sharp edge is nearly so
        break;
    }
    case LightKind::directional: {
        const double angle = glm::radians(light.angular_radius);
        r.shape = light_directional;
        put(r.normal, -unit_vector(light.direction));
        r.versine = static_cast<float>(versine(angle));
        domain = 2 * pi * versine(angle);
        // The irradiance E of a uniform cone facing it is pi L sin^2, and 2 pi (1 - cos) its solid angle.
        factor = 2 / (1 + std::cos(angle));
        break;
    }
    }
}

/// What of the light rays can meet by chance; `domain`: as of fill_shape().
void fill_seen(const Light& light, double domain, LightRecord& r) {
    if (is_delta(light))
        return;
    const double sine = std::sin(glm::radians(light.angular_radius));
    const bool by_irradiance = light.kind == LightKind::directional;
    put(r.emitted, dvec3(light.radiance) / (by_irradiance ? pi * sine * sine : 1.0));
    r.domain = static_cast<float>(light.kind == LightKind::sphere ? 2 * pi : domain);
}

} // namespace

float sample_spacing(const Settings& s, double domain, int samples) {
    return static_cast<float>(s.edge_pixels * std::sqrt(domain / std::max(samples, 1) / s.samples));
}

std::optional<LightRecord> light_record(const Light& light, const Settings& s, const dvec3& origin) {
    LightRecord r{};
    double domain = 0, factor = 0;
    fill_shape(light, origin, r, domain, factor);
    if (!(factor > 0 && std::max({light.radiance.x, light.radiance.y, light.radiance.z}) > 0))
        return std::nullopt;
    r.samples = is_delta(light) ? 1 : s.light_samples;
    put(r.radiance, dvec3(light.radiance) * (factor / (pi * r.samples)));
    fill_seen(light, domain, r);
    r.spacing = sample_spacing(s, domain, r.samples);
    return r;
}

} // namespace razor
