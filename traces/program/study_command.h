// razor-trace study: how far samples of a trace are off, and what they cost.
#pragma once

#include "razor/program/study/study_options.h"

#include <CLI/CLI.hpp>

namespace traces {

class StudyCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return command_->parsed(); }
    /// Returns the exit code. Throws Error.
    int run() const;

private:
    razor::StudyOptions options_;
    CLI::App* command_ = nullptr;
};

} // namespace traces
