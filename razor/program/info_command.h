// razor info: what a scene consists of.
#pragma once

#include "razor/program/scene_options.h"

namespace razor {

class InfoCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Whether it is the one that was given.
    bool given() const { return command_->parsed(); }

    /// Prints what the parsed options name and returns the exit code. Throws UserError.
    int run() const;

private:
    CLI::App* command_ = nullptr;
    SceneOptions scene_;
    std::string json_;
};

} // namespace razor
