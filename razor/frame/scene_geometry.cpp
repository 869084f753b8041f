#include "razor/frame/scene_geometry.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor {

namespace {

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    glm::dvec3 centre() const { return low * 0.5 + high * 0.5; }
};

double distance_to(const Box& b, const glm::dvec3& p) {
    return glm::length(p - glm::clamp(p, b.low, b.high));
}

/// One level serves a whole mesh for now: the footprint of a pixel at the mesh's nearest point, but no nearer
/// than an eighth of the way to its centre (a floor reaches under the camera).
double automatic_edge_length(const Scene& scene, const Box& box) {
    const Camera& camera = scene.camera;
    double centre = glm::length(box.centre() - camera.position);
    double distance = std::max(distance_to(box, camera.position), centre / 8);
    double film = 2 * std::tan(camera.fov_degrees * (3.14159265358979323846 / 360)) * distance;
    double length = scene.settings.edge_pixels * film / scene.settings.height;
    double size = glm::length(box.high - box.low);
    double least = std::max(size * 1e-6, 1e-30);
    return std::clamp(length, least, 1e30);
}

} // namespace

double nearest_power_of_two(double length) {
    return std::exp2(std::round(std::log2(length)));
}

SceneGeometry locate_scene(const Scene& scene) {
    SceneGeometry g;
    Box all;
    std::vector<Box> boxes;
    for (const Mesh& mesh : scene.meshes) {
        Box box;
        for (const glm::dvec3& p : mesh.points)
            box.add(p);
        all.add(box.low);
        all.add(box.high);
        boxes.push_back(box);
    }
    g.origin = all.centre();
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        g.mesh_origins.emplace_back(boxes[i].centre() - g.origin);
        double length = mesh.edge_length > 0 ? mesh.edge_length : automatic_edge_length(scene, boxes[i]);
        g.edge_lengths.push_back(nearest_power_of_two(length));
    }
    g.reach = glm::length(all.high - all.low) + glm::length(scene.camera.position - g.origin);
    g.reach = std::max(g.reach, 1e-30);
    return g;
}

} // namespace razor
