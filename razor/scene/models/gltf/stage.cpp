#include "razor/scene/models/gltf/stage.h"

#include "razor/scene/models/gltf/fields.h"

#include <glm/trigonometric.hpp>

#include <numbers>

namespace razor::gltf {
namespace {

constexpr double pi = std::numbers::pi;

class StageReader {
public:
    explicit StageReader(const Document& document)
        : document_(document), text_(Json::parse(document.stage)), file_(document, &text_, "the file") {}

    Stage read(const std::vector<int>& nodes) {
        Stage stage;
        for (const int node : nodes) {
            const Fields carrier = file_.entry("nodes", "node", node);
            const std::string& name = document_.nodes[static_cast<std::size_t>(node)].name;
            if (carrier.has("camera")) {
                stage.cameras.push_back(read_camera(
                    file_.called(carrier.what()).entry("cameras", "camera", carrier.index("camera"))));
                stage.cameras.back().node = node;
                stage.cameras.back().node_name = name;
            }
            const Fields light = carrier.extension("KHR_lights_punctual");
            if (light.stated()) {
                stage.lights.push_back(read_light(file_.extension("KHR_lights_punctual")
                                                      .called(carrier.what())
                                                      .entry("lights", "light", light.index("light"))));
                stage.lights.back().node = node;
                stage.lights.back().node_name = name;
            }
        }
        return stage;
    }

private:
    /// Half of what is seen in one direction (glTF 2.0, 3.10.3.4). A negative one would mirror the picture,
    /// which its text advises against.
    static double magnification(const Fields& orthographic, const char* key) {
        const double half = orthographic.real(key, 0, {-height_range.most, height_range.most});
        if (!(half > 0))
            orthographic.fail(fmt::format("has no {} above 0", key));
        return half;
    }

    static CarriedCamera read_camera(const Fields& f) {
        CarriedCamera camera;
        camera.name = f.text("name", "");
        const std::string type = f.text("type", "");
        if (type == "orthographic") {
            const Fields orthographic = f.object("orthographic");
            const double half_width = magnification(orthographic, "xmag");
            const double half_height = magnification(orthographic, "ymag");
            camera.perspective = false;
            camera.height = 2 * half_height;
            camera.aspect_ratio = half_width / half_height;
            return camera;
        }
        if (type != "perspective")
            f.fail(fmt::format("is of type '{}', neither perspective nor orthographic", printable(type)));
        const Fields perspective = f.object("perspective");
        const double yfov = perspective.real("yfov", 0, {0, 2 * pi});
        if (!(yfov > 0 && yfov < pi))
            perspective.fail("has no yfov between 0 and pi");
        camera.fov_degrees = std::clamp(glm::degrees(yfov), fov_range.least, fov_range.most);
        camera.aspect_ratio = perspective.real("aspectRatio", 0, {0, 1e6});
        return camera;
    }

    static CarriedLight read_light(const Fields& f) {
        CarriedLight carried;
        carried.name = f.text("name", "");
        Light& light = carried.light;
        light.radiance =
            f.vector("color", glm::vec3(1), unit_range) * f.number("intensity", 1, {0, intensity_range.most});
        const std::string type = f.text("type", "");
        if (type == "point") {
            light.kind = LightKind::point;
        } else if (type == "directional") {
            light.kind = LightKind::directional;
        } else if (type == "spot") {
            light.kind = LightKind::spot;
            const Fields spot = f.object("spot");
            const double outer = spot.real("outerConeAngle", pi / 4, {0, pi});
            const double inner = spot.real("innerConeAngle", 0, {0, outer});
            if (!(outer > 0))
                spot.fail("has an outerConeAngle of 0");
            light.cone_angle = glm::degrees(outer);
            light.cone_delta = glm::degrees(outer - inner);
        } else {
            f.fail(fmt::format("is of type '{}', neither point, spot nor directional", printable(type)));
        }
        return carried;
    }

    const Document& document_;
    Json text_;
    Fields file_;
};

} // namespace

Stage read_stage(const Document& document, const std::vector<int>& nodes) {
    return document.stage.empty() ? Stage{} : StageReader(document).read(nodes);
}

} // namespace razor::gltf
