// Camera, light and ground for models that come without.
#pragma once

#include "razor/scene/description.h"

#include <filesystem>

namespace razor {

/// Which axis of a model file points up.
enum class Up : std::uint8_t { y, z };

struct FramingOptions {
    Up up = Up::y;
    bool floor = true; // a wide flat rectangle under the model
    Scheme scheme = Scheme::catmull_clark;
    double crease_angle = no_crease_angle; // of the model: see MeshDescription
    Settings settings;                     // the picture's shape decides how far the camera stands away
};

/// A scene of one model. What a glTF file brings is used: its first perspective camera, and its lights,
/// beside which the sky is black. What it does not is placed: turned y up, seen from slightly above and from
/// the right, lit by a rectangle at the upper left and a constant sky, on a floor (where the camera is
/// placed, too); all in the model's own units. Throws UserError where the
/// file cannot be read or it reaches beyond 1e24: what is placed about it reaches further, and must stay
/// below 1e30.
SceneDescription frame_model(const std::filesystem::path& path, const FramingOptions& options);

/// The same for a table of instances.
SceneDescription frame_instances(const std::filesystem::path& path, const FramingOptions& options);

/// Places the camera so that all faces of all meshes are in the picture.
void place_camera(SceneDescription& scene);

/// Replaces the lights and the sky by ones that suit the meshes' extent and the camera's direction.
void place_light_and_sky(SceneDescription& scene);

} // namespace razor
