// razor compare: how far a picture is from a reference.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace razor {

class CompareCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Whether it is the one that was given.
    bool given() const { return command_->parsed(); }

    /// Compares what the parsed options name and returns the exit code. Throws UserError.
    int run() const;

private:
    int run_identical() const;

    CLI::App* command_ = nullptr;
    std::string picture_, reference_, json_;
    std::vector<std::string> outputs_;
    std::string pixels_per_degree_, tone_mapper_, start_exposure_, stop_exposure_, exposures_;
    bool identical_ = false;
};

} // namespace razor
