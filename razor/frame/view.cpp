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

PictureCamera picture_camera(const Camera& camera, const Settings& settings) {
    const View v = view_of(camera);
    const FilmExtent film = film_extent(camera, settings);
    const bool perspective = camera.projection == Projection::perspective;
    // Columns: what each coordinate is of a point.
    const auto put = [](std::array<float, 16>& m, std::size_t column, const glm::dvec3& along,
                        double constant) {
        for (int row = 0; row < 3; ++row)
            m[static_cast<std::size_t>(4 * row) + column] = static_cast<float>(along[row]);
        m[12 + column] = static_cast<float>(constant);
    };
    const auto offset = [&](const glm::dvec3& along) { return -glm::dot(along, camera.position); };
    PictureCamera out;
    put(out.world_to_camera, 0, v.right, offset(v.right));
    put(out.world_to_camera, 1, v.up, offset(v.up));
    put(out.world_to_camera, 2, v.forward, offset(v.forward));
    out.world_to_camera[15] = 1;
    // x = 1/2 + right / (2 half width w), y = 1/2 - up / (2 half height w), w = depth or 1.
    const glm::dvec3 depth = perspective ? v.forward : glm::dvec3(0);
    const double one = perspective ? offset(v.forward) : 1;
    const glm::dvec3 x = v.right / (2 * film.half_width), y = -v.up / (2 * film.half_height);
    put(out.world_to_ndc, 0, x + depth / 2.0, offset(x) + one / 2);
    put(out.world_to_ndc, 1, y + depth / 2.0, offset(y) + one / 2);
    put(out.world_to_ndc, 2, perspective ? glm::dvec3(0) : v.forward, perspective ? -1 : offset(v.forward));
    put(out.world_to_ndc, 3, depth, one);
    out.screen_width = perspective ? static_cast<float>(2 * film.half_width) : 1;
    return out;
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
