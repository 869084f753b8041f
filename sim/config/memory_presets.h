// Memories by name: what memory.preset sets.
#pragma once

#include "sim/config/config.h"

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// The first is the default.
const std::vector<MemoryConfig>& memory_presets();
/// Gives every memory key the preset's value, but those of the chip and its controller: controller_cycles.
bool memory_preset_sets(const Config& config, std::string_view key);
void apply_memory_preset(Config& config, const std::string& name);

} // namespace sim
