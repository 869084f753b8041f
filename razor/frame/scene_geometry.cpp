#include "razor/frame/scene_geometry.h"

#include "razor/frame/view.h"
#include "razor/scene/error.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace razor {

namespace {

double distance_to(const Box& b, const glm::dvec3& p) {
    return glm::length(p - glm::clamp(p, b.low, b.high));
}

/// One level serves a whole mesh for now: the footprint of a pixel at the mesh's nearest point, but no nearer
/// than an eighth of the way to its centre (a floor reaches under the camera).
double automatic_edge_length(const Scene& scene, const Box& box) {
    const Camera& camera = dicing_camera(scene);
    double centre = glm::length(box.centre() - camera.position);
    double distance = std::max(distance_to(box, camera.position), centre / 8);
    double length = scene.settings.edge_pixels * pixel_footprint(camera, scene.settings) * distance;
    double size = glm::length(box.high - box.low);
    double least = std::max(size * 1e-6, 1e-30);
    return std::clamp(length, least, 1e30);
}

} // namespace

double nearest_power_of_two(double length) {
    int exponent = 0;
    const double fraction = std::frexp(length, &exponent); // in [1/2, 1)
    return std::ldexp(1.0, fraction < 0.70710678118654752 ? exponent - 1 : exponent);
}

namespace {

/// Boxes of meshes where they stand. Copies that only translate share the work.
class WorldBoxes {
public:
    explicit WorldBoxes(const std::vector<Mesh>& meshes) : meshes_(meshes) {}
    Box operator()(int mesh, const Affine& world) {
        std::array<double, 9> key{};
        for (int i = 0; i < 9; ++i)
            key[static_cast<std::size_t>(i)] = world.linear[i / 3][i % 3];
        auto [turned, fresh] = turned_.try_emplace({mesh, key});
        if (fresh)
            for (const glm::dvec3& p : meshes_[static_cast<std::size_t>(mesh)].points)
                turned->second.add(world.linear * p);
        return {turned->second.low + world.translation, turned->second.high + world.translation};
    }

private:
    const std::vector<Mesh>& meshes_;
    std::map<std::pair<int, std::array<double, 9>>, Box> turned_;
};

/// Origins of meshes: the centres of their points. The first instance that neither turns nor scales its mesh
/// gets it without a move: the origin is shifted to where single precision can put it.
std::vector<glm::dvec3> place_origins(const Scene& scene, const FlatGraph& flat, const glm::dvec3& origin) {
    std::vector<glm::dvec3> origins;
    for (const Mesh& mesh : scene.meshes) {
        Box box;
        for (const glm::dvec3& p : mesh.points)
            box.add(p);
        origins.push_back(box.centre());
    }
    std::vector<bool> shifted(origins.size(), false);
    for (const FlatInstance& i : flat.instances) {
        const auto mesh = static_cast<std::size_t>(i.mesh);
        const Affine& world = flat.nodes[static_cast<std::size_t>(i.node)].world;
        if (shifted[mesh] || world.linear != glm::dmat3(1))
            continue;
        const glm::dvec3 centre = origins[mesh] + (world.translation - origin);
        origins[mesh] = glm::dvec3(glm::vec3(centre)) - (world.translation - origin);
        shifted[mesh] = true;
    }
    return origins;
}

/// Where the mesh's origin comes to lie, and what of that single precision cannot say.
void place_instance(const Affine& world, const glm::dvec3& mesh_origin, const glm::dvec3& origin, double size,
                    Instance& placed) {
    placed.linear = world.linear;
    const glm::dvec3 at = world.linear * mesh_origin + (world.translation - origin);
    placed.origin = glm::vec3(at);
    placed.offset = glm::vec3(at - glm::dvec3(placed.origin));
    for (int k = 0; k < 3; ++k)
        if (std::abs(placed.offset[k]) < std::ldexp(size, -28)) // less than points are rounded by
            placed.offset[k] = 0;
}

/// Gives all instances of a mesh the finest level that one of them has.
void share_levels(std::vector<Instance>& instances, const std::vector<FlatInstance>& flat,
                  std::size_t meshes) {
    std::vector<double> least(meshes, std::numeric_limits<double>::infinity());
    for (const Instance& i : instances) {
        double& length = least[static_cast<std::size_t>(i.mesh)];
        length = std::min(length, i.mesh_edge_length);
    }
    for (std::size_t n = 0; n < instances.size(); ++n) {
        Instance& i = instances[n];
        i.mesh_edge_length = least[static_cast<std::size_t>(i.mesh)];
        i.edge_length = std::clamp(i.mesh_edge_length * flat[n].scale, 1e-30, 1e30);
    }
}

} // namespace

FlatGraph lay_out(const Scene& scene, std::span<const Box> mesh_bounds) {
    try {
        return flatten(drawn_graph(scene.graph, scene.meshes.size()), mesh_bounds);
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: {}", scene.name, error.what()));
    }
}

SceneGeometry locate_scene(const Scene& scene, const std::vector<bool>& drawn) {
    SceneGeometry g;
    std::vector<Box> of_meshes;
    for (const Mesh& mesh : scene.meshes)
        of_meshes.push_back(bounds_of_used_points(mesh.points, mesh.face_vertices));
    const FlatGraph flat = lay_out(scene, of_meshes);
    Box all;
    std::vector<Box> boxes;
    std::vector<bool> seen;
    WorldBoxes box_of(scene.meshes);
    for (const FlatInstance& i : flat.instances) {
        boxes.push_back(box_of(i.mesh, flat.nodes[static_cast<std::size_t>(i.node)].world));
        all.add(boxes.back());
        seen.push_back(drawn[static_cast<std::size_t>(i.mesh)]);
    }
    g.origin = all.centre();
    g.mesh_origins = place_origins(scene, flat, g.origin);
    for (std::size_t n = 0; n < flat.instances.size(); ++n) {
        const FlatInstance& i = flat.instances[n];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(i.mesh)];
        Instance placed;
        placed.mesh = i.mesh;
        placed.material = i.material >= 0 ? i.material : mesh.material;
        place_instance(flat.nodes[static_cast<std::size_t>(i.node)].world,
                       g.mesh_origins[static_cast<std::size_t>(i.mesh)], g.origin,
                       glm::length(boxes[n].high - boxes[n].low), placed);
        double length = mesh.edge_length > 0 ? mesh.edge_length : automatic_edge_length(scene, boxes[n]);
        length *= i.rate;
        length = std::ldexp(nearest_power_of_two(length), scene.settings.lod.coarser);
        placed.mesh_edge_length = std::clamp(std::ldexp(length, i.level_offset), 1e-30, 1e30);
        placed.edge_length = std::clamp(std::ldexp(length, i.level_offset) * i.scale, 1e-30, 1e30);
        g.instances.push_back(placed);
    }
    if (scene.settings.lod == Lod::fixed)
        share_levels(g.instances, flat.instances, scene.meshes.size());
    if (std::find(seen.begin(), seen.end(), true) != seen.end())
        g.graph = build_hierarchy(flat, seen);
    g.reach = glm::length(all.high - all.low) + glm::length(scene.camera.position - g.origin);
    g.reach =
        std::max(g.reach + scene.camera.aperture_radius,
                 glm::length(all.high - all.low) + glm::length(dicing_camera(scene).position - g.origin));
    g.reach = std::max(g.reach, 1e-30);
    return g;
}

} // namespace razor
