// Cameras and lights of glTF 2.0 files (models/gltf/stage.h), with the animation of the nodes that carry
// them.
#pragma once

#include "razor/scene/animation/model_stage.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace razor {

struct GltfStage {
    std::shared_ptr<const ModelStage> stage; // null: the file's scene has neither cameras nor lights
    std::vector<std::string> clips;          // as of GltfModel
};

/// `clip`: name of an animation; empty: the first, if there is one. `cycle`: see ModelStage. Throws
/// UserError: one line `file: cause; mend`.
GltfStage read_gltf_stage(const std::filesystem::path& path, const std::string& clip, double cycle);

} // namespace razor
