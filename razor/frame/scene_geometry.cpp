#include "razor/frame/scene_geometry.h"

#include "razor/frame/displacement.h"
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
class AutomaticLength {
public:
    explicit AutomaticLength(const Scene& scene)
        : from_(dicing_camera(scene).position),
          everywhere_(dicing_camera(scene).projection == Projection::orthographic),
          pixels_(scene.settings.edge_pixels * pixel_footprint(dicing_camera(scene), scene.settings)) {}

    double operator()(const Box& box) const {
        const double size = glm::length(box.high - box.low);
        const double least = std::max(size * 1e-6, 1e-30);
        if (everywhere_)
            return std::clamp(pixels_, least, 1e30);
        double centre = glm::length(box.centre() - from_);
        double distance = std::max(distance_to(box, from_), centre / 8);
        return std::clamp(pixels_ * distance, least, 1e30);
    }

private:
    glm::dvec3 from_;
    bool everywhere_; // at any distance
    double pixels_;   // at distance 1
};

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

/// The centre of its points; of a mesh that some instance draws where it stands, shifted to where single
/// precision can put it, so that this instance needs no move.
glm::dvec3 origin_of(const Mesh& mesh, bool stands, const glm::dvec3& origin) {
    Box box;
    for (const glm::dvec3& p : mesh.points)
        box.add(p);
    const glm::dvec3 centre = box.centre();
    return stands ? glm::dvec3(glm::vec3(centre - origin)) + origin : centre;
}

bool is_identity(const Affine& world) {
    return world.linear == glm::dmat3(1) && world.translation == glm::dvec3(0);
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

/// Target edge lengths of an instance by itself.
void level_instance(const Scene& scene, const AutomaticLength& automatic, const FlatInstance& flat,
                    const Box& box, Instance& placed) {
    const double stated = scene.meshes[static_cast<std::size_t>(flat.mesh)].edge_length;
    double length = stated > 0 ? stated : automatic(box);
    length *= flat.rate;
    length = std::ldexp(nearest_power_of_two(length), scene.settings.lod.coarser);
    placed.mesh_edge_length = std::clamp(std::ldexp(length, flat.level_offset), 1e-30, 1e30);
    placed.edge_length = std::clamp(std::ldexp(length, flat.level_offset) * flat.scale, 1e-30, 1e30);
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

void locate_instance(SceneGeometry& g, const Scene& scene, const AutomaticLength& automatic, std::size_t n) {
    const FlatInstance& i = g.flat.instances[n];
    const auto mesh = static_cast<std::size_t>(i.mesh);
    Instance placed;
    placed.mesh = i.mesh;
    if (i.material >= 0)
        placed.material = i.material;
    else
        placed.material = scene.meshes[mesh].face_materials.empty() ? scene.meshes[mesh].material : -1;
    place_instance(g.flat.nodes[static_cast<std::size_t>(i.node)].world, g.mesh_origins[mesh], g.origin,
                   glm::length(g.boxes[n].high - g.boxes[n].low), placed);
    level_instance(scene, automatic, i, g.boxes[n], placed);
    g.instances[n] = placed;
}

void measure_reach(SceneGeometry& g, const Scene& scene) {
    const Box& all = g.graph.bounds();
    const double extent = glm::length(all.high - all.low);
    g.reach = std::max({extent + glm::length(scene.camera.position - g.origin) +
                            scene.camera.aperture_radius + film_reach(scene.camera, scene.settings),
                        extent + glm::length(dicing_camera(scene).position - g.origin), 1e-30});
}

const Box& bounds_of(const SceneGeometry& g, std::int32_t instance) {
    const std::int32_t node = g.flat.instances[static_cast<std::size_t>(instance)].node;
    return g.flat.nodes[static_cast<std::size_t>(node)].bounds;
}

const Affine& world_of(const SceneGeometry& g, std::size_t instance) {
    return g.flat.nodes[static_cast<std::size_t>(g.flat.instances[instance].node)].world;
}

bool same_view(const Camera& a, const Camera& b) {
    return a.position == b.position && a.target == b.target && a.up == b.up &&
           a.fov_degrees == b.fov_degrees && a.projection == b.projection && a.height == b.height;
}

/// Levels of all instances; appends those that have others now.
void level_all(SceneGeometry& g, const Scene& scene, std::vector<std::int32_t>& changed) {
    const bool shared = scene.settings.lod == Lod::fixed;
    const std::vector<Instance> before = shared ? g.instances : std::vector<Instance>{};
    const auto note = [&](std::size_t n, const Instance& was) {
        if (g.instances[n].edge_length != was.edge_length ||
            g.instances[n].mesh_edge_length != was.mesh_edge_length)
            changed.push_back(static_cast<std::int32_t>(n));
    };
    const AutomaticLength automatic(scene);
    Instance was;
    for (std::size_t n = 0; n < g.instances.size(); ++n) {
        Instance& i = g.instances[n];
        was.edge_length = i.edge_length;
        was.mesh_edge_length = i.mesh_edge_length;
        level_instance(scene, automatic, g.flat.instances[n], g.boxes[n], i);
        if (!shared)
            note(n, was);
    }
    if (!shared)
        return;
    share_levels(g.instances, g.flat.instances, scene.meshes.size());
    for (std::size_t n = 0; n < g.instances.size(); ++n)
        note(n, before[n]);
}

void keep_once(std::vector<int>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
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
    g.drawn = drawn;
    g.displacements = displacement_bounds(scene);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        g.mesh_bounds.push_back(displaced_bounds(scene.meshes[m], g.displacements[m]));
    g.flat = lay_out(scene, g.mesh_bounds);
    std::vector<Box> bounds;
    std::vector<bool> seen;
    WorldBoxes box_of(scene.meshes);
    g.standing.assign(scene.meshes.size(), 0);
    for (std::size_t n = 0; n < g.flat.instances.size(); ++n) {
        const auto mesh = static_cast<std::size_t>(g.flat.instances[n].mesh);
        g.boxes.push_back(box_of(g.flat.instances[n].mesh, world_of(g, n)));
        bounds.push_back(bounds_of(g, static_cast<std::int32_t>(n)));
        seen.push_back(drawn[mesh]);
        g.stands.push_back(is_identity(world_of(g, n)));
        g.standing[mesh] += g.stands.back() ? 1 : 0;
    }
    g.graph = Hierarchy(bounds, seen);
    g.origin = g.graph.grid().origin;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        g.mesh_origins.push_back(origin_of(scene.meshes[m], g.standing[m] > 0, g.origin));
    g.instances.resize(g.flat.instances.size());
    const AutomaticLength automatic(scene);
    for (std::size_t n = 0; n < g.instances.size(); ++n)
        locate_instance(g, scene, automatic, n);
    if (scene.settings.lod == Lod::fixed)
        share_levels(g.instances, g.flat.instances, scene.meshes.size());
    g.camera = dicing_camera(scene);
    measure_reach(g, scene);
    return g;
}

std::optional<GeometryChanges> follow(SceneGeometry& g, const FlatIndex& index, const Scene& scene,
                                      const SceneChanges& changes) {
    GeometryChanges result{{}, changes.meshes};
    for (const int m : changes.meshes) {
        const auto mesh = static_cast<std::size_t>(m);
        g.mesh_bounds[mesh] = displaced_bounds(scene.meshes[mesh], g.displacements[mesh]);
    }
    const bool bare = scene.graph.groups.empty();
    const SceneGraph of_meshes = bare ? drawn_graph(scene.graph, scene.meshes.size()) : SceneGraph{};
    try {
        result.instances = follow(g.flat, index, bare ? of_meshes : scene.graph, g.mesh_bounds,
                                  changes.placements, changes.meshes);
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: {}", scene.name, error.what()));
    }
    WorldBoxes box_of(scene.meshes);
    std::vector<Hierarchy::Moved> moved;
    for (const std::int32_t i : result.instances) {
        const auto n = static_cast<std::size_t>(i);
        const int mesh = g.flat.instances[n].mesh;
        g.boxes[n] = box_of(mesh, world_of(g, n));
        moved.push_back({i, bounds_of(g, i)});
        const bool stands = is_identity(world_of(g, n));
        if (stands != g.stands[n]) {
            g.standing[static_cast<std::size_t>(mesh)] += stands ? 1 : -1;
            g.stands[n] = stands;
            result.meshes.push_back(mesh); // if its origin is another now
        }
    }
    if (!g.graph.move(moved))
        return std::nullopt;
    std::erase_if(result.meshes, [&](int m) {
        const auto mesh = static_cast<std::size_t>(m);
        const glm::dvec3 before = g.mesh_origins[mesh];
        g.mesh_origins[mesh] = origin_of(scene.meshes[mesh], g.standing[mesh] > 0, g.origin);
        if (g.mesh_origins[mesh] != before) {
            const std::span<const std::int32_t> all = index.instances_of(mesh);
            result.instances.insert(result.instances.end(), all.begin(), all.end());
            return false;
        }
        return std::find(changes.meshes.begin(), changes.meshes.end(), m) == changes.meshes.end();
    });
    keep_once(result.instances);
    keep_once(result.meshes);
    const AutomaticLength automatic(scene);
    for (const std::int32_t n : result.instances)
        locate_instance(g, scene, automatic, static_cast<std::size_t>(n));
    const bool other_view = !same_view(g.camera, dicing_camera(scene));
    g.camera = dicing_camera(scene);
    if (other_view || (scene.settings.lod == Lod::fixed && !result.instances.empty())) {
        level_all(g, scene, result.instances);
        keep_once(result.instances);
    }
    measure_reach(g, scene);
    return result;
}

} // namespace razor
