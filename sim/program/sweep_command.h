// razor-sim sweep: many designs of one study, side by side.
#pragma once

#include "razor/program/study/study_options.h"

#include <CLI/CLI.hpp>

namespace sim {

class SweepCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code. Throws razor::UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    razor::StudyOptions options_;
};

} // namespace sim
