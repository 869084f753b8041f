// Reads what a memory told its devices and says which rules of the data sheet were broken: every pair of
// commands near enough is compared, from the configuration alone.
#pragma once

#include "sim/config/config.h"
#include "sim/memory/dram_command.h"

#include <map>
#include <string>
#include <vector>

namespace sim::test {

/// Broken rules by name, with how often. The rules are named after their parameters; further ones are "state"
/// (a command that the bank is in no state for), "command bus", "data bus" and "refresh time".
std::map<std::string, int> broken_rules(const MemoryConfig& c, std::vector<DramCommand> log);

} // namespace sim::test
