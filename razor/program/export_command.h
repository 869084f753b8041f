// razor export-mesh: the diced mesh of a scene as an OBJ file.
#pragma once

#include "razor/program/scene_options.h"

namespace razor {

class ExportCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Whether it is the one that was given.
    bool given() const { return command_->parsed(); }

    /// Dices what the parsed options name, writes it and returns the exit code. Throws UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    SceneOptions scene_;
    std::string output_, isa_ = "auto";
};

} // namespace razor
