#include "tests/materials/plain_lights.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Any unit vector across it.
dvec3 across(const dvec3& z) {
    return glm::normalize(glm::cross(std::abs(z.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), z));
}
/// At that cosine to the axis, and so many turns about it.
dvec3 about(const dvec3& axis, double cosine, double turns) {
    const dvec3 x = across(axis), y = glm::cross(axis, x);
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0)), phi = 2 * pi * turns;
    return sine * std::cos(phi) * x + sine * std::sin(phi) * y + cosine * axis;
}

/// Of a point of a surface of that area that faces `normal`.
PlainLight of_area(const Light& light, const dvec3& from, const dvec3& point, const dvec3& normal,
                   double area) {
    const dvec3 way = point - from;
    const double away = glm::length(way), facing = -glm::dot(normal, way / away);
    const double seen = std::max(facing, 0.0) * area / (away * away);
    return {way / away, away, seen * dvec3(light.radiance)};
}

/// Of a spot, what of its intensity goes there: a cubic of the cosine, from the cone's edge inwards.
double in_cone(const Light& light, const dvec3& direction) {
    const double end = std::cos(glm::radians(light.cone_angle));
    const double whole = std::cos(glm::radians(light.cone_angle - light.cone_delta));
    const double cosine = glm::dot(glm::normalize(light.direction), -direction);
    const double t = std::clamp((cosine - end) / (whole - end), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Of a distant one: what it shines with where it is seen.
dvec3 distant_radiance(const Light& light) {
    return dvec3(light.radiance) / (pi * std::pow(std::sin(glm::radians(light.angular_radius)), 2));
}

} // namespace

PlainLight choose_of_light(const Light& light, const dvec3& from, double s, double t) {
    switch (light.kind) {
    case LightKind::rectangle: {
        const dvec3 n = glm::cross(light.edge_u, light.edge_v);
        const double area = glm::length(n);
        return of_area(light, from, light.corner + s * light.edge_u + t * light.edge_v, n / area, area);
    }
    case LightKind::disk: {
        const dvec3 n = glm::normalize(light.direction);
        return of_area(light, from, light.position + light.radius * std::sqrt(s) * about(n, 0, t), n,
                       pi * light.radius * light.radius);
    }
    case LightKind::sphere: { // of the half of it that is towards the point
        const dvec3 n = about(glm::normalize(from - light.position), 1 - s, t);
        return of_area(light, from, light.position + light.radius * n, n,
                       2 * pi * light.radius * light.radius);
    }
    case LightKind::point:
    case LightKind::spot: {
        const dvec3 way = light.position - from;
        const double away = glm::length(way);
        const double share = light.kind == LightKind::spot ? in_cone(light, way / away) : 1;
        return {way / away, away, dvec3(light.radiance) * (share / (away * away))};
    }
    case LightKind::directional: {
        const dvec3 axis = -glm::normalize(light.direction);
        if (is_delta(light))
            return {axis, infinity, dvec3(light.radiance)};
        const double versine = 1 - std::cos(glm::radians(light.angular_radius));
        return {about(axis, 1 - s * versine, t), infinity, 2 * pi * versine * distant_radiance(light)};
    }
    }
    return {};
}

dvec3 met_light(const Light& light, const dvec3& o, const dvec3& d, double end) {
    if (is_delta(light))
        return dvec3(0);
    if (light.kind == LightKind::directional) {
        const double cosine = glm::dot(d, -glm::normalize(light.direction));
        const bool seen = end == infinity && cosine >= std::cos(glm::radians(light.angular_radius));
        return seen ? distant_radiance(light) : dvec3(0);
    }
    if (light.kind == LightKind::sphere) {
        const dvec3 way = light.position - o;
        const double along = glm::dot(way, d), rest = glm::dot(way, way) - light.radius * light.radius;
        const double root = along * along - rest;
        const bool seen = rest > 0 && along > 0 && root >= 0 && along - std::sqrt(root) < end;
        return seen ? dvec3(light.radiance) : dvec3(0);
    }
    const bool disk = light.kind == LightKind::disk;
    const dvec3 n = disk ? light.direction : glm::cross(light.edge_u, light.edge_v);
    const double facing = -glm::dot(n, d);
    if (facing <= 0)
        return dvec3(0);
    const double t = glm::dot(n, o - (disk ? light.position : light.corner)) / facing;
    if (t <= 0 || t >= end)
        return dvec3(0);
    if (disk)
        return glm::length(o + t * d - light.position) <= light.radius ? dvec3(light.radiance) : dvec3(0);
    const dvec3 p = o + t * d - light.corner;
    const double u = glm::dot(glm::cross(p, light.edge_v), n) / glm::dot(n, n);
    const double v = glm::dot(glm::cross(light.edge_u, p), n) / glm::dot(n, n);
    return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? dvec3(light.radiance) : dvec3(0);
}

} // namespace razor::test
