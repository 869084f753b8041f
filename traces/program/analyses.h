// The commands of razor-trace that answer questions about caches.
#pragma once

#include "traces/program/analysis_options.h"

#include <CLI/CLI.hpp>

#include <string>

namespace traces {

/// Misses by the size of a cache: LRU, sets of some ways, Belady's optimum; exact, or from a sample of lines.
class CurveCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    analysis::Table exact();
    analysis::Table sampled(double rate);

    CLI::App* app_ = nullptr;
    AnalysisOptions options_;
    std::string sizes_, ways_, rate_, heading_;
    bool optimum_ = false;
};

/// How many others are touched between two touches of a line.
class ReuseCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    CLI::App* app_ = nullptr;
    AnalysisOptions options_;
};

/// What a trace touches and misses over time.
class WindowsCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    CLI::App* app_ = nullptr;
    AnalysisOptions options_;
    std::string length_, sizes_;
};

/// What becomes of lines: bytes used, sharing, false sharing, the hottest.
class LinesCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    CLI::App* app_ = nullptr;
    AnalysisOptions options_;
    int hottest_ = 0;
};

/// LRU caches of objects of any size.
class ObjectsCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    CLI::App* app_ = nullptr;
    AnalysisOptions options_;
    std::string sizes_;
};

} // namespace traces
