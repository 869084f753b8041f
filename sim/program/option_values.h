// What options may not have as their values, whatever they mean.
#pragma once

#include <CLI/CLI.hpp>

namespace sim {

/// Throws razor::UserError where an option of the subcommand that was given has - in the place of a file or a
/// folder.
void refuse_dashes(const CLI::App& app);

} // namespace sim
