// razor-sim validate: the validation table, run here and now.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace sim {

class ValidateCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code: 1 if a bar was missed. Throws razor::UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    std::string json_;
};

} // namespace sim
