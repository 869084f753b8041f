// The commands of razor-trace that answer questions about caches and memory: a file each.
#pragma once

#include "traces/program/analysis_options.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <vector>

namespace traces {

class AnalysisCommand {
public:
    /// `by`: what references are told apart by if nothing else is asked for; null: they are not.
    AnalysisCommand(const char* name, const char* meaning, const char* by)
        : name_(name), meaning_(meaning), by_(by) {}
    AnalysisCommand(const AnalysisCommand&) = delete;
    AnalysisCommand& operator=(const AnalysisCommand&) = delete;
    virtual ~AnalysisCommand() = default;

    void add_to(CLI::App& app) {
        app_ = app.add_subcommand(name_, meaning_);
        options_.add_to(*app_, by_, draws());
        add_options(*app_);
    }
    bool parsed() const { return app_->parsed(); }
    /// Throws Error, Interrupted.
    virtual void run() = 0;

protected:
    /// Whether it gives a chart besides its table.
    virtual bool draws() const { return false; }
    /// Its own, besides those of all.
    virtual void add_options(CLI::App&) {}
    AnalysisOptions options_;

private:
    const char *name_, *meaning_, *by_;
    CLI::App* app_ = nullptr;
};

/// All of them, as --help lists them.
std::vector<std::unique_ptr<AnalysisCommand>> analyses();

std::unique_ptr<AnalysisCommand> curve_command();
std::unique_ptr<AnalysisCommand> reuse_command();
std::unique_ptr<AnalysisCommand> windows_command();
std::unique_ptr<AnalysisCommand> causes_command();
std::unique_ptr<AnalysisCommand> lines_command();
std::unique_ptr<AnalysisCommand> use_command();
std::unique_ptr<AnalysisCommand> strides_command();
std::unique_ptr<AnalysisCommand> footprint_command();
std::unique_ptr<AnalysisCommand> replicas_command();
std::unique_ptr<AnalysisCommand> objects_command();
std::unique_ptr<AnalysisCommand> picture_command();
std::unique_ptr<AnalysisCommand> tiles_command();
std::unique_ptr<AnalysisCommand> report_command();
/// In builds with the machine.
std::unique_ptr<AnalysisCommand> rows_command();

} // namespace traces
