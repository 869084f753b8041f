#include "razor/frame/light_bounds.h"

#include "razor/frame/unit_vector.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor {

using glm::dvec3;
using std::numbers::pi;

namespace {

/// The smallest that holds both, if they are not all directions.
NormalCone unite(const NormalCone& a, const NormalCone& b) {
    if (a.angle >= pi || b.angle >= pi)
        return {};
    const double between = std::atan2(glm::length(glm::cross(a.axis, b.axis)), glm::dot(a.axis, b.axis));
    if (std::min(between + b.angle, pi) <= a.angle)
        return a;
    if (std::min(between + a.angle, pi) <= b.angle)
        return b;
    const double angle = (a.angle + between + b.angle) / 2;
    const dvec3 about = glm::cross(a.axis, b.axis);
    if (angle >= pi || glm::dot(about, about) == 0)
        return {};
    const double turn = angle - a.angle;
    const dvec3 side = glm::normalize(glm::cross(glm::normalize(about), a.axis));
    return {glm::normalize(a.axis * std::cos(turn) + side * std::sin(turn)), angle};
}

} // namespace

void LightBounds::add(const LightBounds& b) {
    if (power == 0) {
        *this = b;
        return;
    }
    box.add(b.box);
    normals = unite(normals, b.normals);
    emission = std::max(emission, b.emission);
    power += b.power;
}

bool has_place(const Light& light) {
    return light.kind != LightKind::directional;
}

LightBounds bounds_of(const Light& l, const dvec3& origin) {
    LightBounds b;
    const double bright = (double{l.radiance.x} + l.radiance.y + l.radiance.z) / 3;
    b.emission = pi / 2;
    b.power = bright;
    const dvec3 at = l.position - origin;
    switch (l.kind) {
    case LightKind::rectangle: {
        const dvec3 corner = l.corner - origin, normal = glm::cross(l.edge_u, l.edge_v);
        for (const dvec3& p : {corner, corner + l.edge_u, corner + l.edge_v, corner + l.edge_u + l.edge_v})
            b.box.add(p);
        b.normals = {glm::normalize(normal), 0};
        b.power *= glm::length(normal);
        return b;
    }
    case LightKind::disk: {
        const dvec3 normal = unit_vector(l.direction);
        const dvec3 reach = l.radius * glm::sqrt(glm::max(dvec3(1) - normal * normal, dvec3(0)));
        b.box.add(at - reach);
        b.box.add(at + reach);
        b.normals = {normal, 0};
        b.power *= pi * l.radius * l.radius;
        return b;
    }
    case LightKind::sphere:
        b.box.add(at - dvec3(l.radius));
        b.box.add(at + dvec3(l.radius));
        b.power *= pi * l.radius * l.radius;
        return b;
    case LightKind::spot:
        b.box.add(at);
        b.normals = {unit_vector(l.direction), glm::radians(l.cone_angle - l.cone_delta)};
        b.emission = glm::radians(l.cone_delta);
        return b;
    case LightKind::point:
    case LightKind::directional:
        b.box.add(at);
        return b;
    }
    return b;
}

} // namespace razor
