// What razor info says, for people and for programs.
#pragma once

#include "razor/scene/graph/box.h"
#include "razor/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace razor {

/// What of a scene is drawn.
struct SceneUse {
    std::vector<std::int64_t> instances;      // of each mesh
    std::vector<std::int64_t> material_faces; // of each material: faces in all instances
    std::vector<bool> textures;               // of each: some drawn material shows it
};

/// `bounds`: of each mesh. Throws UserError where the scene graph cannot be laid out.
SceneUse use_of(const Scene& scene, std::span<const Box> bounds);

std::string text_of(const Scene& scene, const SceneUse& use);
nlohmann::ordered_json json_of(const Scene& scene, const SceneUse& use);

} // namespace razor
