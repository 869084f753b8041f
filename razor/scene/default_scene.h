// The scene that is rendered when none is named: the very text of configs/scenes/default.toml, compiled in.
#pragma once

#include "razor/scene/description.h"

namespace razor {

SceneDescription default_scene();

} // namespace razor
