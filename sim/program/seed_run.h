// The seed of a closed form, made by running one tile of a machine, and kept in a file.
#pragma once

#include "razor/scene/scene.h"
#include "sim/estimate/seed.h"

#include <atomic>
#include <string>
#include <vector>

namespace sim {

struct KeptSeed {
    Config machine;    // of one tile
    std::string scene; // as TOML
    Seed seed;
    std::vector<double> drivers;  // of the crowded run: screen_work.h
    double processor_seconds = 0; // of the host, to make it
};

/// Renders the frame on one tile of `machine`, and a part of it with a lone worker. `scene_text`: the scene
/// as TOML. Throws Stopped, or razor::Cancelled.
KeptSeed make_seed(const Config& machine, const razor::Scene& scene, const std::string& scene_text,
                   bool quiet, const std::atomic<bool>& interrupted);

void write_seed(const std::string& file, const KeptSeed& seed);
/// `option` names the file in messages. Throws razor::UserError where it is no seed.
KeptSeed read_seed(const std::string& option, const std::string& file);
/// Throws razor::UserError where the seed says nothing of this machine or scene.
void check_seed(const std::string& option, const std::string& file, const KeptSeed& seed,
                const Config& machine, const std::string& scene_text);

} // namespace sim
