// Cameras (glTF 2.0, 3.10) and lights (KHR_lights_punctual) that nodes carry.
#pragma once

#include "razor/scene/animation/model_stage.h"
#include "razor/scene/models/gltf/document.h"

namespace razor::gltf {

/// Of cameras yfov, aspectRatio and whether they are perspective are read: rays are not clipped at znear and
/// zfar. Of lights colour, intensity and cones; `range` is passed over, since light falls off by the square
/// of the distance alone.
struct Stage {
    std::vector<CarriedCamera> cameras;
    std::vector<CarriedLight> lights;
};

/// Of these nodes, in their order. Throws UserError.
Stage read_stage(const Document& document, const std::vector<int>& nodes);

} // namespace razor::gltf
