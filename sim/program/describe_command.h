// razor-sim describe: what a chip is and can do at most, as lines and as a drawing.
#pragma once

#include "sim/program/run_command.h"

#include <CLI/CLI.hpp>

#include <string>

namespace sim {

class DescribeCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code. Throws razor::UserError and ConfigError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    MachineOptions machine_;
    std::string output_;
};

} // namespace sim
