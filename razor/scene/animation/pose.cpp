#include "razor/scene/animation/pose.h"

#include "razor/scene/attachment.h"
#include "razor/scene/error.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

template <class Value> void follow(Value& value, const Track<Value>& track, const Timing& timing, double t) {
    if (!track.empty())
        value = track.at(t, timing);
}

/// `posed`: a list of objects of the posed scene, `moving`: the same of the other one.
void pose(std::vector<ObjectDescription>& posed, const SceneDescription& description,
          const std::vector<ObjectDescription>& moving, double t) {
    for (std::size_t o = 0; o < posed.size(); ++o) {
        posed[o].transform = place_at(description, moving, o, t);
        posed[o].keys = {};
        posed[o].attachment.reset();
    }
}

void pose(Camera& camera, const CameraKeys& keys, double t) {
    follow(camera.position, keys.position, keys.timing, t);
    follow(camera.target, keys.target, keys.timing, t);
    follow(camera.up, keys.up, keys.timing, t);
    follow(camera.fov_degrees, keys.fov, keys.timing, t);
    follow(camera.aperture_radius, keys.aperture_radius, keys.timing, t);
    follow(camera.focus_distance, keys.focus_distance, keys.timing, t);
    follow(camera.height, keys.height, keys.timing, t);
    // Cubics pass beyond their keys.
    camera.fov_degrees = std::clamp(camera.fov_degrees, fov_range.least, fov_range.most);
    camera.height = std::clamp(camera.height, height_range.least, height_range.most);
    camera.aperture_radius = std::max(camera.aperture_radius, 0.0);
    camera.focus_distance = std::max(camera.focus_distance, 0.0);
}

void pose(Light& light, const LightKeys& keys, double t) {
    const auto pose_field = [&](std::string_view, Range range, bool, auto& value, const auto& track) {
        using Value = std::remove_reference_t<decltype(value)>;
        if (track.empty())
            return;
        const auto now = track.at(t, keys.timing);
        if constexpr (std::is_same_v<Value, double>)
            value = std::clamp(now, range.least, range.most); // cubics pass beyond their keys
        else
            value = Value(glm::clamp(now, glm::dvec3(range.least), glm::dvec3(range.most)));
    };
    visit_light_fields(light.kind, pose_field, light, keys);
}

void check(const std::optional<Mistake>& mistake, const SceneDescription& scene, double seconds,
           const std::string& whose = "") {
    if (mistake)
        throw UserError(
            fmt::format("{}: {} s after the beginning {}{}", scene.name, seconds, whose, mistake->message));
}

} // namespace

bool is_animated(const SceneDescription& d) {
    const auto moves = [&](const ObjectDescription& o) { return o.keys.any() || hangs_on_motion(d, o); };
    return d.camera_keys.any() || (d.camera_from && camera_moves(*d.camera_from)) ||
           std::any_of(d.lights_from.begin(), d.lights_from.end(),
                       [](const LightsFromModel& l) { return lights_move(l.from); }) ||
           std::any_of(d.meshes.begin(), d.meshes.end(), changes_shape) ||
           std::any_of(d.objects.begin(), d.objects.end(), moves) ||
           std::any_of(d.light_keys.begin(), d.light_keys.end(),
                       [](const LightKeys& k) { return k.any(); }) ||
           std::any_of(d.groups.begin(), d.groups.end(), [&](const GroupDescription& g) {
               return std::any_of(g.objects.begin(), g.objects.end(), moves);
           });
}

Transform transform_at(const ObjectDescription& object, double t) {
    const TransformKeys& keys = object.keys;
    Transform transform = object.transform;
    follow(transform.scale, keys.scale, keys.timing, t);
    follow(transform.rotate, keys.rotate, keys.timing, t);
    follow(transform.translate, keys.translate, keys.timing, t);
    return transform;
}

MeshDescription mesh_at(const SceneDescription& description, std::size_t mesh, double t) {
    MeshDescription m = description.meshes[mesh];
    try {
        pose_cage(m, t);
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: mesh '{}': {}", description.name, printable(m.name), error.what()));
    }
    return m;
}

void pose_view(SceneDescription& posed, const SceneDescription& moving, double t) {
    posed.camera = moving.camera;
    posed.lights = moving.lights;
    posed.camera_keys = {};
    posed.light_keys.clear();
    posed.camera_from.reset();
    posed.lights_from.clear();
    if (moving.camera_from) {
        posed.camera = camera_of(*moving.camera_from, moving.settings, t);
        posed.camera.aperture_radius = moving.camera.aperture_radius;
        posed.camera.focus_distance = moving.camera.focus_distance;
        check(mistake_of(posed.camera, "camera"), moving, t);
    }
    for (const LightsFromModel& run : moving.lights_from) {
        const std::vector<Light> lights = lights_of(run.from, t);
        std::copy(lights.begin(), lights.end(),
                  posed.lights.begin() + static_cast<std::ptrdiff_t>(run.first));
    }
    if (moving.camera_keys.any()) {
        pose(posed.camera, moving.camera_keys, t);
        check(mistake_of(posed.camera, "camera"), moving, t);
    }
    for (std::size_t l = 0; l < moving.light_keys.size(); ++l) {
        pose(posed.lights[l], moving.light_keys[l], t);
        check(mistake_of(posed.lights[l]), moving, t,
              moving.lights.size() == 1 ? ""
                                        : fmt::format("of light {} of {}: ", l + 1, moving.lights.size()));
    }
}

SceneDescription pose_at(const SceneDescription& description, double t) {
    SceneDescription d = description;
    for (std::size_t m = 0; m < d.meshes.size(); ++m)
        if (changes_shape(d.meshes[m]))
            d.meshes[m] = mesh_at(description, m, t);
    pose(d.objects, description, description.objects, t);
    for (std::size_t g = 0; g < d.groups.size(); ++g)
        pose(d.groups[g].objects, description, description.groups[g].objects, t);
    pose_view(d, description, t);
    return d;
}

SceneDescription pose_of_frame(const SceneDescription& description, int frame) {
    return pose_at(description, frame / description.frame_rate);
}

std::optional<Mistake> mistake_of(const Camera& camera, const std::string& name) {
    if (camera.position == camera.target)
        return Mistake{"position", fmt::format("{0}.position equals {0}.target; move one of them", name)};
    const glm::dvec3 view = glm::normalize(camera.target - camera.position);
    if (camera.up == glm::dvec3(0) || glm::length(glm::cross(view, glm::normalize(camera.up))) < 1e-9)
        return Mistake{"up", fmt::format("{}.up is zero or along the line of sight; turn it", name)};
    return std::nullopt;
}

std::optional<Mistake> mistake_of(const Light& light) {
    using enum LightKind;
    const auto has_radius = [&] { return light.kind == disk || light.kind == sphere; };
    const auto has_direction = [&] {
        return light.kind == disk || light.kind == spot || light.kind == directional;
    };
    if (has_radius() && !(light.radius > 0))
        return Mistake{"radius", "light.radius is 0; make it positive, or the light a point"};
    if (has_direction() && light.direction == glm::dvec3(0))
        return Mistake{"direction", "light.direction is zero; write where the light goes"};
    if (light.kind == spot && !(light.cone_angle > 0))
        return Mistake{"cone_angle", "light.cone_angle is 0; make it positive"};
    if (light.kind == spot && light.cone_delta > light.cone_angle)
        return Mistake{"cone_delta", "light.cone_delta exceeds light.cone_angle; make it smaller"};
    if (light.kind != rectangle)
        return std::nullopt;
    if (light.edge_u == glm::dvec3(0) || light.edge_v == glm::dvec3(0) ||
        glm::length(glm::cross(glm::normalize(light.edge_u), glm::normalize(light.edge_v))) < 1e-9)
        return Mistake{"edge_u",
                       "light.edge_u and light.edge_v span no rectangle; make both long and turn one"};
    if (std::abs(glm::dot(glm::normalize(light.edge_u), glm::normalize(light.edge_v))) > 1e-6)
        return Mistake{"edge_v", "light.edge_u and light.edge_v are not at right angles; turn one"};
    return std::nullopt;
}

} // namespace razor
