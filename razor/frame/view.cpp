#include "razor/frame/view.h"

#include "razor/frame/layout.h"

#include <glm/geometric.hpp>

#include <algorithm>
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
    const double half_height = camera.projection == Projection::orthographic
                                   ? camera.height / 2
                                   : std::tan(camera.fov_degrees * (3.14159265358979323846 / 360));
    return {half_height * settings.width / settings.height, half_height};
}

double film_reach(const Camera& camera, const Settings& settings) {
    if (camera.projection != Projection::orthographic)
        return 0;
    const auto [a, b] = film_extent(camera, settings);
    return std::hypot(a, b);
}

double pixel_footprint(const Camera& camera, const Settings& settings) {
    const auto [a, b] = film_extent(camera, settings);
    if (camera.projection == Projection::orthographic)
        return 2 * std::sqrt(a * b / settings.width / settings.height);
    // Of a rectangle seen from above its middle.
    const double solid_angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    return std::sqrt(solid_angle / settings.width / settings.height);
}

CameraField camera_field(const Camera& camera, const Settings& settings) {
    constexpr double cap = gradation_cap;
    if (camera.projection == Projection::orthographic)
        return {settings.edge_pixels * pixel_footprint(camera, settings), 0, 0};
    const double growth = std::min(settings.edge_pixels * pixel_footprint(camera, settings), cap);
    const double radius = camera.aperture_radius;
    if (!(radius > 0))
        return {0, 0, growth};
    const double share = radius * std::sqrt(3.14159265358979323846 / settings.samples);
    const double focus = focus_distance(camera);
    const double slope = std::min(settings.edge_pixels * share / focus, cap - growth);
    return {slope * focus, -slope, growth};
}

} // namespace razor
