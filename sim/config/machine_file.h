// Machine files: TOML, one table a section, every key in the table of parameter_table.cpp. `inherit =
// "other.toml"` (relative to the file; or a list of files, of which the last wins) takes all values of other
// files first. `calibration = "file.json"` (relative likewise) names what analysis/calibration wrote. Layers,
// each over the one before: defaults, inherited files, the file, overrides.
#pragma once

#include "sim/config/config.h"
#include "sim/config/origin.h"

#include <string>
#include <vector>

namespace sim {

/// A machine with the origin of every value.
struct MachineDescription {
    Config config;
    std::string name;            // its file's, without folders
    std::vector<Origin> origins; // of parameters(), in that order; empty: not known
    std::string calibration; // a file, its folders resolved: what its counts lack beside real ones; or empty
    std::vector<std::string>
        files{}; // that were read, whether a value of theirs is left or not, or are named
};

/// Reads a file and applies overrides of the form `section.key=value`. Throws ConfigError.
MachineDescription describe_machine(const std::string& file, const std::vector<std::string>& overrides = {});
/// The same, from text; `name` stands for the file in messages, and inherited files are looked for beside it.
MachineDescription describe_machine_text(const std::string& text, const std::string& name,
                                         const std::vector<std::string>& overrides = {});
/// Without the origins.
Config read_machine(const std::string& file, const std::vector<std::string>& overrides = {});
Config parse_machine(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides = {});

/// All parameters with their values, meanings, units, bounds and origins, as a machine file that reads back
/// as the same machine, marks included.
std::string print_machine(const MachineDescription& machine);
std::string print_machine(const Config& config);

} // namespace sim
