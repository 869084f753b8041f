// razor-sim compare: two designs by the reports of their runs.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace sim {

class CompareCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code. Throws razor::UserError and ConfigError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    std::vector<std::string> first_, second_;
    std::string json_, noise_ = "0";
    bool all_ = false;
};

} // namespace sim
