#include "razor/scene/framing.h"

#include "razor/scene/error.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/models/gltf_stage.h"
#include "razor/scene/scene_objects.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor {
namespace {

constexpr double azimuth_degrees = 32;   // of the camera, from +z towards +x
constexpr double elevation_degrees = 17; // of the camera above the horizon
constexpr double fov_degrees = 30;
constexpr double margin = 1.06; // free room around the model
constexpr double least_radius = 1e-30;
constexpr double largest_model_extent = 1e24; // the camera may stand a million radii away

struct Extent {
    glm::dvec3 centre{0};
    double radius = 1; // half the bounding box's diagonal; positive even for a single point
    double lowest = 0;
};

/// Adds the points of a mesh that faces use, before objects place it.
void add_used_points(const MeshDescription& mesh, std::vector<glm::dvec3>& points) {
    std::vector<bool> used(mesh.cage->points.size());
    for (const int corner : mesh.cage->face_vertices) {
        used[static_cast<std::size_t>(corner)] = true;
    }
    const std::vector<glm::dvec3> placed = placed_points(mesh);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (used[i]) {
            points.push_back(placed[i]);
        }
    }
}

/// ... of one that changes its shape at so many moments of its motion.
std::vector<glm::dvec3> used_points(MeshDescription mesh) {
    constexpr int moments = 8;
    std::vector<glm::dvec3> points;
    add_used_points(mesh, points);
    if (changes_shape(mesh)) {
        for (int n = 0; n <= moments; ++n) {
            mesh.playback.moment = motion_length(mesh) * n / moments;
            shape_cage(mesh, 0);
            add_used_points(mesh, points);
        }
    }
    return points;
}

/// The points that faces use, where the scene has them when it begins. Those of instances are made when
/// visited: there may be too many to keep.
class PointCloud {
public:
    explicit PointCloud(const SceneDescription& scene) {
        for (const MeshDescription& mesh : scene.meshes) {
            points_.push_back(used_points(mesh));
        }
        const SceneGraph graph = build_graph(scene);
        if (graph.groups.empty()) {
            for (std::size_t m = 0; m < points_.size(); ++m) {
                places_.push_back({m, {}});
            }
            return;
        }
        const FlatGraph flat = flatten(graph, mesh_bounds(scene));
        for (const FlatInstance& instance : flat.instances) {
            places_.push_back({static_cast<std::size_t>(instance.mesh),
                               flat.nodes[static_cast<std::size_t>(instance.node)].world});
        }
    }

    template <class Visit> void for_each(const Visit& visit) const {
        for (const auto& [mesh, world] : places_) {
            for (const glm::dvec3& p : points_[mesh]) {
                visit(world(p));
            }
        }
    }

private:
    std::vector<std::vector<glm::dvec3>> points_; // of each mesh
    std::vector<std::pair<std::size_t, Affine>> places_;
};

Extent extent_of(const PointCloud& points) {
    Box box;
    points.for_each([&](const glm::dvec3& p) { box.add(p); });
    if (box.empty()) {
        return {};
    }
    const glm::dvec3& least = box.low;
    const glm::dvec3& most = box.high;
    // Halves first: the difference of two large numbers may overflow.
    const glm::dvec3 half = 0.5 * most - 0.5 * least;
    Extent extent{0.5 * least + 0.5 * most, std::hypot(half.x, half.y, half.z), least.y};
    const double reach =
        std::max({std::abs(extent.centre.x), std::abs(extent.centre.y), std::abs(extent.centre.z)});
    if (extent.radius <= 1e-12 * reach || extent.radius < least_radius) { // as good as a point
        extent.radius = 1e-6 * reach > least_radius ? 1e-6 * reach : 1;
    }
    return extent;
}

glm::dvec3 camera_direction() {
    const double azimuth = glm::radians(azimuth_degrees);
    const double elevation = glm::radians(elevation_degrees);
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            std::cos(elevation) * std::cos(azimuth)};
}

Camera camera_for(const PointCloud& points, const Settings& settings) {
    const Extent extent = extent_of(points);
    const glm::dvec3 towards = camera_direction();
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), towards));
    const glm::dvec3 up = glm::cross(towards, right);
    const double half_height = std::tan(glm::radians(0.5 * fov_degrees)) / margin;
    const double half_width = half_height * settings.width / settings.height;
    double distance = 0.2 * extent.radius;
    points.for_each([&](const glm::dvec3& p) {
        const glm::dvec3 from_centre = p - extent.centre;
        const double ahead = glm::dot(from_centre, towards);
        distance = std::max({distance, ahead + std::abs(glm::dot(from_centre, right)) / half_width,
                             ahead + std::abs(glm::dot(from_centre, up)) / half_height});
    });
    Camera camera;
    camera.target = extent.centre;
    camera.position = extent.centre + distance * towards;
    camera.fov_degrees = fov_degrees;
    return camera;
}

/// A rectangle three radii away at the upper left of the camera, facing the centre.
Light light_for(const Extent& extent) {
    const glm::dvec3 towards = camera_direction();
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), towards));
    const glm::dvec3 from = glm::normalize(glm::dvec3(0, 1.15, 0) - 0.75 * right + 0.55 * towards);
    const double side = 2 * extent.radius;
    const glm::dvec3 across = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), from));
    Light light;
    light.edge_u = side * across;
    light.edge_v = side * glm::cross(across, from); // u x v points from the light to the centre
    light.corner = extent.centre + 3.0 * extent.radius * from - 0.5 * light.edge_u - 0.5 * light.edge_v;
    light.radiance = glm::vec3(8.0F, 7.5F, 6.8F);
    return light;
}

constexpr glm::vec3 sky_radiance{0.36F, 0.40F, 0.46F};

MeshDescription floor_under(const Extent& extent) {
    MeshDescription floor;
    floor.name = "floor";
    floor.shape = "plane";
    const double side = 300 * extent.radius;
    floor.parameters = {{"width", side}, {"depth", side}, {"columns", 1}, {"rows", 1}};
    floor.scheme = Scheme::bilinear;
    floor.material = "floor";
    // Slightly below: a flat model must not lie in the floor.
    floor.translate = {extent.centre.x, extent.lowest - 2e-3 * extent.radius, extent.centre.z};
    load_cage(floor);
    return floor;
}

SceneDescription empty_scene(const FramingOptions& options) {
    SceneDescription scene;
    scene.settings = options.settings;
    scene.materials = {{"model", {0.72F, 0.66F, 0.60F}}};
    return scene;
}

Extent checked_extent(const PointCloud& points) {
    const Extent extent = extent_of(points);
    const glm::dvec3 c = glm::abs(extent.centre);
    const double furthest = std::max({c.x, c.y, c.z}) + extent.radius;
    if (!(furthest <= largest_model_extent)) {
        throw UserError(fmt::format("points lie up to {:g} from the origin; scale it down, to {:g} at most",
                                    furthest, largest_model_extent));
    }
    return extent;
}

void light_and_frame(SceneDescription& scene, const std::filesystem::path& path,
                     const FramingOptions& options) try {
    const PointCloud points(scene);
    const Extent extent = checked_extent(points);
    if (!scene.camera_from) {
        scene.camera = camera_for(points, scene.settings);
    }
    if (scene.lights.empty()) {
        scene.lights = {light_for(extent)};
        scene.sky = sky_radiance;
    }
    if (options.floor && !scene.camera_from) {
        scene.materials.push_back({"floor", {0.50F, 0.49F, 0.48F}});
        scene.meshes.push_back(floor_under(extent));
    }
} catch (const UserError& error) {
    throw UserError(fmt::format("{}: {}", printable(path.string(), 1000), error.what()));
}

} // namespace

namespace {

/// Camera and lights of the model's own, if it has any.
void use_stage(SceneDescription& scene, const MeshDescription& model) {
    FromModel from{.file = model.file, .name = {}, .playback = model.playback, .rotate = model.rotate};
    from.stage = read_gltf_stage(from.file, from.playback.clip, from.playback.timing.cycle).stage;
    if (!from.stage) {
        return;
    }
    if (has_camera(from)) {
        scene.camera_from = from;
        scene.camera = camera_of(from, scene.settings, 0);
    }
    if (!from.stage->lights().empty()) {
        scene.lights = lights_of(from, 0);
        scene.lights_from = {{from, 0, scene.lights.size()}};
    }
}

} // namespace

SceneDescription frame_model(const std::filesystem::path& path, const FramingOptions& options) {
    SceneDescription scene = empty_scene(options);
    MeshDescription& model = scene.meshes.emplace_back();
    model.file = std::filesystem::absolute(path).lexically_normal().string();
    model.crease_angle = options.crease_angle;
    load_cage(model);
    model.name = cage_name(model.file);
    model.scheme = options.scheme;
    if (!model.source->own_materials) {
        model.material = "model";
    }
    scene.name = model.name;
    if (options.up == Up::z) {
        model.rotate.x = -90;
    }
    if (model_file(model.file) == ModelFile::gltf) {
        use_stage(scene, model);
    }
    light_and_frame(scene, path, options);
    return scene;
}

SceneDescription frame_instances(const std::filesystem::path& path, const FramingOptions& options) {
    SceneDescription scene = empty_scene(options);
    ObjectDescription& object = scene.objects.emplace_back();
    object.instances = std::filesystem::absolute(path).lexically_normal().string();
    object.table = std::make_shared<const InstanceTable>(read_instance_table(path));
    object.name = path.stem().string();
    scene.name = object.name;
    CageCache cages;
    add_table_meshes(scene, *object.table, path.string(), options.scheme, "model", cages);
    if (options.up == Up::z) {
        object.transform.rotate.x = -90;
    }
    light_and_frame(scene, path, options);
    return scene;
}

void place_camera(SceneDescription& scene) {
    scene.camera = camera_for(PointCloud(scene), scene.settings);
}

void place_light_and_sky(SceneDescription& scene) {
    scene.lights = {light_for(extent_of(PointCloud(scene)))};
    scene.sky = sky_radiance;
}

} // namespace razor
