// What the models of a scene hold that scene files may choose by name: cameras, lights, animations and nodes
// of glTF files, tags of MD3 files.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/models/gltf_contents.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace razor {

/// Of all files that meshes, the camera or lights are from, each once. Throws UserError.
std::vector<GltfContents> contents_of(const SceneDescription& description);

/// Nothing where there are none.
std::string text_of(const std::vector<GltfContents>& files);
nlohmann::ordered_json json_of(const std::vector<GltfContents>& files);

/// Tags of the meshes that have some. Nothing where there are none.
std::string text_of_tags(const SceneDescription& description);
nlohmann::ordered_json json_of_tags(const SceneDescription& description);

} // namespace razor
