// What the models of a scene hold that scene files may choose by name: cameras, lights, animations and nodes
// of glTF files; frames, surfaces with what they are painted with, and tags of MD3 files.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/models/gltf_contents.h"
#include "razor/scene/models/md3_materials.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace razor {

/// Of all files that meshes, the camera or lights are from, each once. Throws UserError.
std::vector<GltfContents> contents_of(const SceneDescription& description);

/// Nothing where there are none.
std::string text_of(const std::vector<GltfContents>& files);
nlohmann::ordered_json json_of(const std::vector<GltfContents>& files);

/// Frames and surfaces of the MD3 files that meshes are from, each file once. Throws UserError.
struct Md3Contents {
    std::string file;
    std::size_t frames = 0;
    std::vector<Md3Surface> surfaces;
    std::vector<Md3Paint> paints; // of each
};
std::vector<Md3Contents> md3_contents_of(const SceneDescription& description);

/// Nothing where there are none.
std::string text_of(const std::vector<Md3Contents>& files);
nlohmann::ordered_json json_of(const std::vector<Md3Contents>& files);

/// Tags of the meshes that have some. Nothing where there are none.
std::string text_of_tags(const SceneDescription& description);
nlohmann::ordered_json json_of_tags(const SceneDescription& description);

} // namespace razor
