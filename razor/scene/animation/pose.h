// A scene at one moment.
#pragma once

#include "razor/scene/description.h"

namespace razor {

/// Whether anything moves.
bool is_animated(const SceneDescription& description);

/// The scene as it is `seconds` after its beginning: without keys, and a complete scene by itself. Throws
/// UserError where camera or light are impossible then.
SceneDescription pose_at(const SceneDescription& description, double seconds);
/// ... in this frame: at frame / rate.
SceneDescription pose_of_frame(const SceneDescription& description, int frame);

// pose_at() part by part: an object, a mesh, camera and lights together (and what is wrong with these).
Transform transform_at(const ObjectDescription& object, double seconds); // attachment.h says where that is
MeshDescription mesh_at(const SceneDescription& description, std::size_t mesh, double seconds);
void pose_view(SceneDescription& posed, const SceneDescription& moving, double seconds);

/// What is wrong with a camera, or a light: the key to mend and a message; nothing if it is possible.
struct Mistake {
    std::string key, message;
};
std::optional<Mistake> mistake_of(const Camera& camera, const std::string& name);
std::optional<Mistake> mistake_of(const Light& light);

} // namespace razor
