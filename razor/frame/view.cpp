#include "razor/frame/view.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace razor {

View view_of(const Camera& camera) {
    View v{};
    v.forward = camera.target - camera.position;
    double length = glm::length(v.forward);
    v.forward = length > 0 ? v.forward / length : glm::dvec3(0, 0, -1);
    glm::dvec3 up = camera.up;
    v.right = glm::cross(v.forward, up);
    if (!(glm::length(v.right) > 1e-9 * glm::length(up))) {
        up = std::abs(v.forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        v.right = glm::cross(v.forward, up);
    }
    v.right = glm::normalize(v.right);
    v.up = glm::cross(v.right, v.forward);
    return v;
}

FilmExtent film_extent(const Camera& camera, const Settings& settings) {
    const double tangent = std::tan(camera.fov_degrees * (3.14159265358979323846 / 360));
    return {tangent * settings.width / settings.height, tangent};
}

double pixel_footprint(const Camera& camera, const Settings& settings) {
    const auto [a, b] = film_extent(camera, settings);
    // Of a rectangle seen from above its middle.
    const double solid_angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    return std::sqrt(solid_angle / settings.width / settings.height);
}

} // namespace razor
