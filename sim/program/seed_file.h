// The seed of a closed form in a file: JSON, with the machine and the scene that it is of.
#pragma once

#include "sim/estimate/seed.h"
#include "sim/program/screen_work.h"

#include <string>
#include <vector>

namespace sim {

struct KeptSeed {
    Config machine;    // of one tile
    std::string scene; // as TOML
    Seed seed;
    std::vector<double> drivers;   // of the crowded run: screen_work.h
    std::vector<ScreenNeed> needs; // of screen tiles
    double processor_seconds = 0;  // of the host, to make it
};

void write_seed(const std::string& file, const KeptSeed& seed);
/// `option` names the file in messages. Throws razor::UserError where it is no seed.
KeptSeed read_seed(const std::string& option, const std::string& file);
/// Throws razor::UserError where the seed says nothing of this machine or scene.
void check_seed(const std::string& option, const std::string& file, const KeptSeed& seed,
                const Config& machine, const std::string& scene_text);

} // namespace sim
