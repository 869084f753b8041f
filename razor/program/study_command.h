// razor study: errors of pictures against what they cost.
#pragma once

#include "razor/program/study/study_options.h"

#include <CLI/CLI.hpp>

namespace razor {

class StudyCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    bool given() const { return command_->parsed(); }
    /// Returns the exit code. Throws UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    StudyOptions options_;
};

} // namespace razor
