#include "razor/scene/from_model.h"

#include "razor/scene/error.h"
#include "razor/scene/models/gltf_stage.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

bool is_called(const auto& carried, const std::string& name) {
    return name.empty() || carried.node_name == name || carried.name == name || carried.called() == name;
}

/// Null: there is none.
const CarriedCamera* find_camera(const FromModel& from) {
    const auto& cameras = from.stage->cameras();
    const auto found = std::find_if(cameras.begin(), cameras.end(),
                                    [&](const CarriedCamera& c) { return is_called(c, from.name); });
    return found == cameras.end() ? nullptr : &*found;
}

std::vector<const CarriedLight*> find_lights(const FromModel& from) {
    std::vector<const CarriedLight*> found;
    for (const CarriedLight& light : from.stage->lights())
        if (is_called(light, from.name))
            found.push_back(&light);
    return found;
}

[[noreturn]] void fail(const FromModel& from, std::string_view message) {
    throw UserError(fmt::format("{}: {}", printable(from.file, 1000), message));
}

template <class Carried>
[[noreturn]] void fail_to_find(const FromModel& from, std::string_view kind,
                               const std::vector<Carried>& all) {
    std::string list;
    for (const Carried& carried : all)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", printable(carried.called()));
    fail(from, from.name.empty() || list.empty()
                   ? fmt::format("its scene has no {}; give a glTF file that has one", kind)
                   : fmt::format("no {} is named '{}'; there are: {}", kind, printable(from.name), list));
}

/// A node's place in the scene.
class Place {
public:
    Place(const FromModel& from, const Affine& node, const std::string& what)
        : world_(to_affine(
                     {.scale = glm::dvec3(from.scale), .rotate = from.rotate, .translate = from.translate}) *
                 node),
          from_(from), what_(what) {
        const glm::dvec3 far = glm::abs(position());
        if (!(std::max({far.x, far.y, far.z}) <= coordinate_range.most) || glm::any(glm::isnan(far)))
            fail(from, fmt::format("the node of {} lies beyond {:g}; mend its transform", what,
                                   coordinate_range.most));
    }

    const glm::dvec3& position() const { return world_.translation; }
    glm::dvec3 ahead() const { return direction(-world_.linear[2]); }
    glm::dvec3 up() const { return direction(world_.linear[1]); }

private:
    glm::dvec3 direction(const glm::dvec3& v) const {
        const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        if (!(largest > 0 && std::isfinite(largest)))
            fail(from_, fmt::format("the node of {} has no direction; mend its scale", what_));
        return glm::normalize(v / largest);
    }

    Affine world_;
    const FromModel& from_;
    std::string what_;
};

const Affine& node_of(const std::vector<Affine>& nodes, int node) {
    return nodes[static_cast<std::size_t>(node)];
}

} // namespace

void load_stage(FromModel& from, bool camera) {
    GltfStage read = read_gltf_stage(from.file, from.playback.clip, from.playback.timing.cycle);
    from.stage = read.stage ? read.stage
                            : std::make_shared<const ModelStage>(Skeleton{}, std::nullopt, 0,
                                                                 std::vector<CarriedCamera>{},
                                                                 std::vector<CarriedLight>{});
    if (from.playback.clip.empty() && !read.clips.empty())
        from.playback.clip = read.clips.front();
    if (!camera) {
        if (find_lights(from).empty())
            fail_to_find(from, "light", from.stage->lights());
        return;
    }
    if (!has_camera(from))
        fail_to_find(from, "camera", from.stage->cameras());
}

bool has_camera(const FromModel& from) {
    return find_camera(from) != nullptr;
}

Camera camera_of(const FromModel& from, const Settings& settings, double seconds) {
    const CarriedCamera& carried = *find_camera(from);
    const std::vector<Affine> nodes = from.stage->nodes_at(from.playback.seconds(seconds));
    const Place place(from, node_of(nodes, carried.node), "the camera");
    Camera camera;
    camera.position = place.position();
    const glm::dvec3 far = glm::abs(camera.position);
    // What one unit adds must not be lost to rounding.
    camera.target =
        camera.position + std::max(from.scale, 1e-9 * std::max({far.x, far.y, far.z})) * place.ahead();
    camera.up = place.up();
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const double wider = std::max(1.0, carried.aspect_ratio / aspect);
    if (!carried.perspective) {
        camera.projection = Projection::orthographic;
        camera.height = carried.height * from.scale * wider;
        if (!(camera.height >= height_range.least && camera.height <= height_range.most))
            fail(from, fmt::format("the camera is {:g} high, which is not from {:g} to {:g}; mend its scale",
                                   camera.height, height_range.least, height_range.most));
        return camera;
    }
    camera.fov_degrees = carried.fov_degrees;
    if (wider > 1)
        camera.fov_degrees =
            std::min(2 * glm::degrees(std::atan(std::tan(0.5 * glm::radians(carried.fov_degrees)) * wider)),
                     fov_range.most);
    return camera;
}

std::vector<Light> lights_of(const FromModel& from, double seconds) {
    const std::vector<Affine> nodes = from.stage->nodes_at(from.playback.seconds(seconds));
    std::vector<Light> lights;
    for (const CarriedLight* carried : find_lights(from)) {
        Light& light = lights.emplace_back(carried->light);
        const Place place(from, node_of(nodes, carried->node), "a light");
        light.position = place.position();
        if (light.kind != LightKind::point)
            light.direction = place.ahead();
        const bool directional = light.kind == LightKind::directional;
        const double factor = (directional ? 1.0 : from.scale * from.scale) / from.lumens_per_watt;
        const glm::dvec3 most((directional ? radiance_range : intensity_range).most);
        light.radiance = glm::vec3(glm::min(factor * glm::dvec3(light.radiance), most));
    }
    return lights;
}

bool camera_moves(const FromModel& from) {
    return !from.playback.moment && from.stage->moves(find_camera(from)->node);
}

bool lights_move(const FromModel& from) {
    const std::vector<const CarriedLight*> lights = find_lights(from);
    return !from.playback.moment && std::any_of(lights.begin(), lights.end(), [&](const CarriedLight* light) {
        return from.stage->moves(light->node);
    });
}

} // namespace razor
