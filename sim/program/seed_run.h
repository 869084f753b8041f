// The seed of a closed form, made by running one tile of a machine.
#pragma once

#include "razor/scene/scene.h"
#include "sim/program/seed_file.h"

#include <atomic>
#include <string>

namespace sim {

/// Renders the frame on one tile of `machine`, and a part of it with a lone worker. `scene_text`: the scene
/// as TOML. Throws Stopped, or razor::Cancelled.
KeptSeed make_seed(const Config& machine, const razor::Scene& scene, const std::string& scene_text,
                   bool quiet, const std::atomic<bool>& interrupted);

} // namespace sim
