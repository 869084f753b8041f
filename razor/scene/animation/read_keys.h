// Keys in scene files: [[object.key]], [[camera.key]], [[light.key]], and beside them `interpolation` and
// `cycle`.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/toml_table.h"

namespace razor {

// `table` is the object's, camera's or light's. Throws UserError naming the place.
TransformKeys read_transform_keys(TomlTable& table);
CameraKeys read_camera_keys(TomlTable& table, Projection projection);
LightKeys read_light_keys(TomlTable& table, LightKind kind);

/// `interpolation`, `cycle` and [[header.key]] as they are read; nothing of what has no keys.
std::string to_toml(const TransformKeys& keys, std::string_view header);
std::string to_toml(const CameraKeys& keys, std::string_view header);
std::string to_toml(const LightKeys& keys, std::string_view header);

} // namespace razor
