// Whether values that a program sets are possible: the ranges of scene files, for values that come from none.
// Each throws UserError: "scene: key: cause; mend".
#pragma once

#include "razor/scene/description.h"

#include <string_view>

namespace razor::api {

void check_settings(std::string_view scene, const Settings& settings);
/// `name`: "camera" or "dicing_camera".
void check_camera(std::string_view scene, const Camera& camera, std::string_view name);
void check_light(std::string_view scene, const Light& light);
void check_radiance(std::string_view scene, std::string_view name, const glm::vec3& radiance);
void check_material_values(const SceneDescription& scene, const Material& material);
void check_transform(std::string_view scene, std::string_view object, const Transform& transform);

} // namespace razor::api
