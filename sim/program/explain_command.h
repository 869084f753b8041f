// razor-sim explain: what the figures of a report mean.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace sim {

class ExplainCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code. Throws razor::UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    std::string words_;
};

} // namespace sim
