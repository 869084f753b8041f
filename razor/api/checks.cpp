#include "razor/api/checks.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/crop.h"
#include "razor/scene/error.h"
#include "razor/scene/filter_fields.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor::api {
namespace {

void check(std::string_view scene, std::string_view name, double value, Range range) {
    if (!(value >= range.least && value <= range.most)) // no number is neither
        throw UserError(fmt::format("{}: {} is {:g}; it must lie between {:g} and {:g}", scene, name, value,
                                    range.least, range.most));
}
void check(std::string_view scene, std::string_view name, const glm::dvec3& value, Range range) {
    for (int axis = 0; axis < 3; ++axis)
        check(scene, name, value[axis], range);
}
void check(std::string_view scene, std::string_view name, const glm::vec3& value, Range range) {
    check(scene, name, glm::dvec3(value), range);
}
void check(std::string_view scene, const std::optional<Mistake>& mistake) {
    if (mistake)
        throw UserError(fmt::format("{}: {}", scene, mistake->message));
}

} // namespace

void check_settings(std::string_view scene, const Settings& s) {
    check(scene, "settings.width", s.width, size_range);
    check(scene, "settings.height", s.height, size_range);
    check(scene, "settings.samples", s.samples, samples_range);
    check(scene, "settings.noise_threshold", s.noise_threshold, noise_threshold_range);
    check(scene, "settings.light_samples", s.light_samples, shadow_samples_range);
    check(scene, "settings.light_choices", s.light_choices, light_choices_range);
    check(scene, "settings.sky_samples", s.sky_samples, shadow_samples_range);
    check(scene, "settings.bounces", s.bounces, bounces_range);
    check(scene, "settings.diffuse_bounces", s.diffuse_bounces, bounces_range);
    check(scene, "settings.seed", s.seed, seed_range);
    check(scene, "settings.edge_pixels", s.edge_pixels, edge_pixels_range);
    check(scene, "settings.filter.radius", s.filter.radius.x, filter_radius_range);
    check(scene, "settings.filter.radius", s.filter.radius.y, filter_radius_range);
    visit_filter_parameters(s.filter, [&](std::string_view name, double value, Range range) {
        check(scene, fmt::format("settings.filter.{}", name), value, range);
    });
    if (std::none_of(lod_words.begin(), lod_words.end(),
                     [&](const auto& word) { return word.second == s.lod; }))
        throw UserError(fmt::format("{}: settings.lod is none that scene files can state; `coarser` is at "
                                    "most 8, and 0 but for `object` and `fixed`",
                                    scene));
    if (const std::string wrong = s.crop == Crop{} ? "" : mistake_of_crop(s.crop, s); !wrong.empty())
        throw UserError(fmt::format("{}: settings.crop: {}", scene, wrong));
}

void check_camera(std::string_view scene, const Camera& camera, std::string_view name) {
    const auto key = [&](std::string_view member) { return fmt::format("{}.{}", name, member); };
    check(scene, key("position"), camera.position, coordinate_range);
    check(scene, key("target"), camera.target, coordinate_range);
    check(scene, key("up"), camera.up, coordinate_range);
    check(scene, key("fov"), camera.fov_degrees, fov_range);
    check(scene, key("height"), camera.height, height_range);
    check(scene, key("aperture_radius"), camera.aperture_radius, aperture_range);
    check(scene, key("focus_distance"), camera.focus_distance, focus_range);
    check(scene, mistake_of(camera, std::string(name)));
}

void check_light(std::string_view scene, const Light& light) {
    visit_light_fields(
        light.kind,
        [&](std::string_view name, Range range, bool, const auto& value) {
            check(scene, fmt::format("light.{}", name), value, range);
        },
        light);
    check(scene, mistake_of(light));
}

void check_radiance(std::string_view scene, std::string_view name, const glm::vec3& radiance) {
    check(scene, name, radiance, radiance_range);
}

void check_material_values(const SceneDescription& scene, const Material& material) {
    if (material.name.empty())
        throw UserError(fmt::format("{}: a material without a name; give it one", scene.name));
    const auto key = [&](std::string_view member) {
        return fmt::format("material '{}': {}", printable(material.name), member);
    };
    visit_material_fields([&](std::string_view name, Range range,
                              const auto& value) { check(scene.name, key(name), value, range); },
                          material);
    visit_material_maps(
        [&](std::string_view name, const TextureMap& map) {
            if (map.texture < -1 || map.texture >= static_cast<int>(scene.textures.size()))
                throw UserError(fmt::format("{}: {} is texture number {}, of {}; -1 is none", scene.name,
                                            key(name), map.texture, scene.textures.size()));
        },
        material);
}

void check_transform(std::string_view scene, std::string_view object, const Transform& transform) {
    const auto key = [&](std::string_view member) {
        return fmt::format("object '{}': {}", printable(object), member);
    };
    check(scene, key("scale"), transform.scale, signed_scale_range);
    check(scene, key("rotate"), transform.rotate, angle_range);
    check(scene, key("translate"), transform.translate, coordinate_range);
    if (transform.matrix) {
        for (int column = 0; column < 3; ++column)
            check(scene, key("matrix"), transform.matrix->linear[column], coordinate_range);
        check(scene, key("matrix"), transform.matrix->translation, coordinate_range);
    }
    if (is_degenerate(to_affine(transform).linear))
        throw UserError(fmt::format("{}: {} flattens it; make it thicker", scene,
                                    key(transform.matrix ? "matrix" : "scale")));
}

} // namespace razor::api
