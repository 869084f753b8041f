#include "razor/api/scene.h"

#include "razor/api/checks.h"
#include "razor/api/scene_state.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/default_scene.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor::api {
namespace {

/// Calls visit(name, place) for each object.
template <class Visit> void each_object(const SceneDescription& scene, Visit visit) {
    const auto list = [&](const std::vector<ObjectDescription>& objects, const std::string& prefix,
                          std::size_t group) {
        for (std::size_t i = 0; i < objects.size(); ++i)
            visit(prefix + objects[i].name,
                  PlacementName{static_cast<std::int32_t>(group) - 1, static_cast<std::int32_t>(i)});
    };
    list(scene.objects, "", 0);
    for (std::size_t g = 0; g < scene.groups.size(); ++g)
        list(scene.groups[g].objects, scene.groups[g].name + "/", g + 1);
}

PlacementName find_object(const SceneDescription& scene, std::string_view name) {
    PlacementName found;
    int times = 0;
    each_object(scene, [&](const std::string& object, PlacementName place) {
        if (object == name) {
            found = place;
            ++times;
        }
    });
    if (times == 0)
        throw UserError(
            fmt::format("{}: there is no object '{}'; objects() lists them", scene.name, printable(name)));
    if (times > 1)
        throw UserError(fmt::format("{}: {} objects are called '{}'; give them names of their own",
                                    scene.name, times, printable(name)));
    return found;
}

/// `Description`: a scene's, const or not.
template <class Description> auto& object_at(Description& scene, const PlacementName& place) {
    const auto number = static_cast<std::size_t>(place.placement);
    return place.group < 0 ? scene.objects[number]
                           : scene.groups[static_cast<std::size_t>(place.group)].objects[number];
}

void check_material(const SceneDescription& scene, std::string_view name) {
    const auto same = [&](const Material& m) { return m.name == name; };
    if (!name.empty() && std::none_of(scene.materials.begin(), scene.materials.end(), same))
        throw UserError(fmt::format("{}: there is no material '{}'; set_material() adds one", scene.name,
                                    printable(name)));
}

} // namespace

Scene Scene::built_in() {
    return Scene(default_scene());
}

Scene Scene::load(const std::filesystem::path& file, const Framing& framing) {
    FramingOptions options;
    options.up = framing.z_up ? Up::z : Up::y;
    options.floor = framing.floor;
    options.scheme = framing.scheme;
    if (!(framing.crease_angle >= 0 && framing.crease_angle <= no_crease_angle))
        throw UserError(fmt::format("framing: crease_angle is {:g}; it must lie between 0 and {:g}",
                                    framing.crease_angle, no_crease_angle));
    options.crease_angle = framing.crease_angle;
    options.settings.width = framing.width;
    options.settings.height = framing.height;
    check_settings("framing", options.settings);
    return Scene(describe(file, options));
}

Scene Scene::parse(std::string_view toml, const std::filesystem::path& folder, std::string_view name) {
    return Scene(parse_scene_file(toml, name, folder));
}

Scene::Scene(SceneDescription description) : state_(State::of(std::move(description))) {}
Scene::Scene(const Scene& other) : Scene(other.description()) {}
Scene& Scene::operator=(const Scene& other) {
    if (this != &other)
        state_ = State::of(other.description());
    return *this;
}
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(Scene&& other) noexcept {
    state_ = std::move(other.state_);
    state_->edits.more = true;
    return *this;
}
Scene::~Scene() = default;

std::string Scene::toml() const {
    return to_toml(state_->description);
}
bool Scene::is_animated() const {
    return razor::is_animated(state_->description);
}
double Scene::frame_rate() const {
    return state_->description.frame_rate;
}
const SceneDescription& Scene::description() const {
    return state_->description;
}

const Settings& Scene::settings() const {
    return state_->description.settings;
}
void Scene::set_settings(const Settings& settings) {
    check_settings(state_->description.name, settings);
    state_->description.settings = settings;
    state_->edits.more = true;
}

const Camera& Scene::camera() const {
    return state_->description.camera;
}
void Scene::set_camera(const Camera& camera) {
    SceneDescription& scene = state_->description;
    check_camera(scene.name, camera, "camera");
    scene.camera = camera;
    scene.camera_keys = {};
    scene.camera_from.reset();
    state_->edits.view = true;
}
const std::optional<Camera>& Scene::dicing_camera() const {
    return state_->description.dicing_camera;
}
void Scene::set_dicing_camera(const std::optional<Camera>& camera) {
    if (camera)
        check_camera(state_->description.name, *camera, "dicing_camera");
    state_->description.dicing_camera = camera;
    state_->edits.view = true;
}

const std::vector<Light>& Scene::lights() const {
    return state_->description.lights;
}
void Scene::set_lights(std::vector<Light> lights) {
    SceneDescription& scene = state_->description;
    for (const Light& light : lights)
        check_light(scene.name, light);
    scene.lights = std::move(lights);
    scene.light_keys.assign(scene.lights.size(), {});
    scene.lights_from.clear();
    state_->edits.view = true;
}

glm::vec3 Scene::sky() const {
    return state_->description.sky;
}
void Scene::set_sky(const glm::vec3& radiance) {
    check_radiance(state_->description.name, "sky.radiance", radiance);
    state_->description.sky = radiance;
    // Where a map lights nothing, no table of it is made.
    (state_->description.sky_map.texture >= 0 ? state_->edits.more : state_->edits.view) = true;
}

const std::vector<Material>& Scene::materials() const {
    return state_->description.materials;
}
void Scene::set_material(const Material& material) {
    SceneDescription& scene = state_->description;
    check_material_values(scene, material);
    const auto place = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& m) { return m.name == material.name; });
    if (place == scene.materials.end())
        scene.materials.push_back(material);
    else
        *place = material;
    state_->edits.more = true;
}

std::vector<std::string> Scene::objects() const {
    std::vector<std::string> names;
    each_object(state_->description,
                [&](const std::string& name, const PlacementName&) { names.push_back(name); });
    return names;
}
const Transform& Scene::transform(std::string_view object) const {
    const SceneDescription& scene = state_->description;
    return object_at(scene, find_object(scene, object)).transform;
}
void Scene::set_transform(std::string_view object, const Transform& transform) {
    SceneDescription& scene = state_->description;
    const PlacementName place = find_object(scene, object);
    check_transform(scene.name, object, transform);
    ObjectDescription& moved = object_at(scene, place);
    moved.transform = transform;
    moved.keys = {};
    state_->edits.objects.push_back(place);
}
void Scene::set_object_material(std::string_view object, std::string_view material) {
    SceneDescription& scene = state_->description;
    const PlacementName place = find_object(scene, object);
    check_material(scene, material);
    object_at(scene, place).material = material;
    state_->edits.more = true;
}

std::vector<std::string> Scene::meshes() const {
    std::vector<std::string> names;
    for (const MeshDescription& mesh : state_->description.meshes)
        names.push_back(mesh.name);
    return names;
}
void Scene::set_mesh_material(std::string_view mesh, std::string_view material) {
    SceneDescription& scene = state_->description;
    const auto found = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                    [&](const MeshDescription& m) { return m.name == mesh; });
    if (found == scene.meshes.end())
        throw UserError(
            fmt::format("{}: there is no mesh '{}'; meshes() lists them", scene.name, printable(mesh)));
    check_material(scene, material);
    found->material = material;
    state_->edits.more = true;
}

} // namespace razor::api
