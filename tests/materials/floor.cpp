#include "tests/materials/floor.h"

#include <glm/trigonometric.hpp>

#include <cmath>

namespace razor::test {

Scene seen_floor(const Material& material, double degrees) {
    Scene s;
    s.name = "floor";
    Mesh m;
    m.name = "floor";
    m.scheme = Scheme::bilinear;
    m.points = {{-100, 0, -100}, {-100, 0, 100}, {100, 0, 100}, {100, 0, -100}};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    m.edge_length = 100;
    s.meshes = {m};
    s.materials = {material};
    s.camera.position = 10.0 * to_scene(view_at(degrees));
    s.camera.target = {0, 0, 0};
    s.camera.fov_degrees = 0.001;
    s.settings = {
        .lod = Lod::fixed, .width = 8, .height = 8, .samples = 16, .light_samples = 4, .sky_samples = 4};
    return s;
}

glm::dvec3 view_at(double degrees) {
    return {std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees))};
}

glm::dvec3 mean_colour(const Scene& scene, const std::string& target, glm::dvec3* spread) {
    RenderOptions options;
    options.threads = 1;
    options.isa = target;
    const RenderResult result = render_native(scene, options);
    glm::dvec3 mean(0), error(0);
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        double sum = 0, squares = 0;
        const std::vector<float>& plane = result.film.find(names[c])->values;
        for (const float value : plane) {
            sum += value;
            squares += double(value) * value;
        }
        const auto n = static_cast<double>(plane.size());
        mean[c] = sum / n;
        error[c] = std::sqrt(std::max(squares / n - mean[c] * mean[c], 0.0) / n);
    }
    if (spread != nullptr)
        *spread = error;
    return mean;
}

} // namespace razor::test
