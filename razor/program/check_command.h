// razor check: what is wrong with a model or a scene, and whether rays escape from its closed bodies.
#pragma once

#include "razor/program/scene_options.h"

#include <CLI/CLI.hpp>

#include <string>

namespace razor {

class CheckCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Whether it is the one that was given.
    bool given() const { return command_->parsed(); }

    /// Checks what the parsed options ask for and returns the exit code: 1 if rays escape or hit what is not
    /// there. Throws UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    SceneOptions scene_;
    std::string escape_, compare_, per_origin_, converge_, isa_ = "auto", json_;
    bool quiet_ = false, strict_ = false;
};

} // namespace razor
