// How well a machine is known, for its reports.
#pragma once

#include "sim/config/machine_file.h"

#include <nlohmann/json.hpp>

namespace sim {

/// Of every parameter: from where its value is, and its mark.
nlohmann::ordered_json provenance_json(const MachineDescription& machine);
/// One line: how many parameters are known, assumed, unmarked, overridden (and set by what is, as by a
/// preset) and left to defaults.
std::string provenance_text(const MachineDescription& machine);

} // namespace sim
