#include "razor/scene/animation/deformer.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace razor {
namespace {

/// sin(2 pi x), exact at multiples of a quarter however large.
double sine_of_turns(double x) {
    x -= std::floor(x);
    if (x >= 1) // of what is below zero by less than one can differ by
        x = 0;
    const double quarters = std::floor(4 * x), rest = (x - quarters / 4) * 2 * std::numbers::pi;
    switch (static_cast<int>(quarters)) {
    case 0:
        return std::sin(rest);
    case 1:
        return std::cos(rest);
    case 2:
        return -std::sin(rest);
    default:
        return -std::cos(rest);
    }
}

double radians(double degrees) {
    return degrees * (std::numbers::pi / 180);
}

/// sin(x) / x
double sinc(double x) {
    return x == 0 ? 1 : std::sin(x) / x;
}

} // namespace

void deform(const Deformer& d, double seconds, std::vector<glm::dvec3>& points) {
    const glm::dvec3 axis = glm::normalize(d.axis);
    const double turns = d.period > 0 ? seconds / d.period : 0;
    const double swing = d.period > 0 ? sine_of_turns(turns + d.phase) : 1;
    if (d.kind == DeformerKind::wave) {
        const glm::dvec3 reach = glm::normalize(d.direction) * d.amount;
        for (glm::dvec3& p : points)
            p += reach * sine_of_turns(glm::dot(p - d.origin, axis) / d.wavelength - turns + d.phase);
        return;
    }
    const double rate = radians(d.amount * swing); // a unit
    if (d.kind == DeformerKind::twist) {
        for (glm::dvec3& p : points) {
            const glm::dvec3 v = p - d.origin;
            const double s = glm::dot(v, axis), angle = rate * s;
            const glm::dvec3 across = v - s * axis;
            p = d.origin + s * axis + std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across);
        }
        return;
    }
    const glm::dvec3 towards = glm::normalize(d.direction - glm::dot(d.direction, axis) * axis);
    for (glm::dvec3& p : points) {
        const glm::dvec3 v = p - d.origin;
        const double s = glm::dot(v, axis), x = glm::dot(v, towards), angle = rate * s;
        if (!(s > 0))
            continue;
        // The arc's end, and from there the cross section; no radius, which a straight axis has not.
        const double along = s * sinc(angle) - x * std::sin(angle);
        const double aside = s * std::sin(angle / 2) * sinc(angle / 2) + x * std::cos(angle);
        p += (along - s) * axis + (aside - x) * towards;
    }
}

} // namespace razor
