// razor render: a scene or a model to pictures and statistics.
#pragma once

#include "razor/program/scene_options.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace razor {

class RenderCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);

    /// Renders what the parsed options ask for and returns the exit code. Throws UserError.
    int run() const;

private:
    SceneOptions scene_;
    std::vector<std::string> outputs_;
    std::string threads_, isa_ = "auto", share_ = "chip", frames_ = "1", statistics_;
    bool print_config_ = false, quiet_ = false, eager_ = false;
};

} // namespace razor
