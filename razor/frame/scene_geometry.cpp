#include "razor/frame/scene_geometry.h"

#include "razor/frame/view.h"
#include "razor/scene/error.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor {

namespace {

double distance_to(const Box& b, const glm::dvec3& p) {
    return glm::length(p - glm::clamp(p, b.low, b.high));
}

/// One level serves a whole mesh for now: the footprint of a pixel at the mesh's nearest point, but no nearer
/// than an eighth of the way to its centre (a floor reaches under the camera).
double automatic_edge_length(const Scene& scene, const Box& box) {
    const Camera& camera = scene.camera;
    double centre = glm::length(box.centre() - camera.position);
    double distance = std::max(distance_to(box, camera.position), centre / 8);
    double length = scene.settings.edge_pixels * pixel_footprint(camera, scene.settings) * distance;
    double size = glm::length(box.high - box.low);
    double least = std::max(size * 1e-6, 1e-30);
    return std::clamp(length, least, 1e30);
}

} // namespace

double nearest_power_of_two(double length) {
    return std::exp2(std::round(std::log2(length)));
}

/// Finest level: no ray asks for less.
double power_of_two_below(double length) {
    return std::exp2(std::floor(std::log2(length)));
}

SceneGeometry locate_scene(const Scene& scene) {
    SceneGeometry g;
    const SceneGraph graph = drawn_graph(scene.graph, scene.meshes.size());
    std::vector<Box> of_meshes;
    for (const Mesh& mesh : scene.meshes)
        of_meshes.push_back(bounds_of_used_points(mesh.points, mesh.face_vertices));
    FlatGraph flat;
    try {
        flat = flatten(graph, of_meshes);
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: {}", scene.name, error.what()));
    }
    Box all;
    std::vector<Box> boxes;
    for (const FlatInstance& i : flat.instances) {
        const Affine& world = flat.nodes[static_cast<std::size_t>(i.node)].world;
        Box box;
        for (const glm::dvec3& p : scene.meshes[static_cast<std::size_t>(i.mesh)].points)
            box.add(world(p));
        all.add(box);
        boxes.push_back(box);
    }
    g.origin = all.centre();
    for (std::size_t n = 0; n < flat.instances.size(); ++n) {
        const FlatInstance& i = flat.instances[n];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(i.mesh)];
        Instance placed;
        placed.mesh = i.mesh;
        placed.material = i.material >= 0 ? i.material : mesh.material;
        placed.world = flat.nodes[static_cast<std::size_t>(i.node)].world;
        placed.origin = glm::vec3(boxes[n].centre() - g.origin);
        double length = mesh.edge_length > 0 ? mesh.edge_length : automatic_edge_length(scene, boxes[n]);
        length *= i.rate;
        length = scene.settings.lod == Lod::fixed ? nearest_power_of_two(length) : power_of_two_below(length);
        placed.edge_length = std::clamp(std::ldexp(length, i.level_offset) * i.scale, 1e-30, 1e30);
        g.instances.push_back(placed);
    }
    g.reach = glm::length(all.high - all.low) + glm::length(scene.camera.position - g.origin);
    g.reach = std::max(g.reach, 1e-30);
    return g;
}

Affine relative_to_origin(const SceneGeometry& geometry, const Instance& instance) {
    return {instance.world.linear,
            instance.world.translation - (geometry.origin + glm::dvec3(instance.origin))};
}

} // namespace razor
