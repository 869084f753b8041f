// A list of what a glTF file holds that is chosen by name.
#pragma once

#include "razor/scene/animation/model_stage.h"
#include "razor/scene/animation/named_nodes.h"

#include <filesystem>
#include <string>
#include <vector>

namespace razor {

struct ClipLength {
    std::string name;
    double seconds = 0; // of its last key

    const std::string& called() const { return name; }
};

struct GltfContents {
    std::string file;
    std::vector<CarriedCamera> cameras;
    std::vector<CarriedLight> lights;
    std::vector<ClipLength> clips;
    std::vector<NamedNode> nodes; // that objects can be attached to
};

/// Throws UserError.
GltfContents read_gltf_contents(const std::filesystem::path& path);

} // namespace razor
