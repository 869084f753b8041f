#include "tests/materials/plain_camera.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

namespace razor::test {

using glm::dvec3;

PlainRay plain_camera_ray(const Camera& camera, double shape, const glm::dvec2& film,
                          const glm::dvec2& lens) {
    const dvec3 forward = glm::normalize(camera.target - camera.position);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const auto on_film = [&](double half_height) {
        return half_height * (shape * film.x * right + film.y * up);
    };
    if (camera.projection == Projection::orthographic)
        return {camera.position + on_film(camera.height / 2), forward};
    const dvec3 sharp =
        focus_distance(camera) * (forward + on_film(std::tan(glm::radians(camera.fov_degrees) / 2)));
    const double r = camera.aperture_radius * std::sqrt(lens.x), phi = 2 * std::numbers::pi * lens.y;
    const dvec3 from = r * std::cos(phi) * right + r * std::sin(phi) * up;
    return {camera.position + from, glm::normalize(sharp - from)};
}

} // namespace razor::test
