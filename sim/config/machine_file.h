// Machine files: TOML, one table a section, every key in the table of parameters.cpp. `inherit =
// "other.toml"` (relative to the file) takes all values of another file first.
#pragma once

#include "sim/config/config.h"

#include <string>
#include <vector>

namespace sim {

/// Reads a file and applies overrides of the form `section.key=value`. Throws ConfigError.
Config read_machine(const std::string& file, const std::vector<std::string>& overrides = {});
/// The same, from text; `name` stands for the file in messages, and inherited files are looked for beside it.
Config parse_machine(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides = {});
/// All parameters with their values, units and meanings, as a machine file that reads back as the same
/// machine.
std::string print_machine(const Config& config);

} // namespace sim
