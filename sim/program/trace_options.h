// The options of razor-sim run that record a trace.
#pragma once

#include "sim/trace/recorder.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace sim {

class TraceOptions {
public:
    void add_to(CLI::App& app);
    /// Where the trace is wanted, or empty.
    const std::string& file() const { return file_; }
    bool wanted() const { return !file_.empty(); }
    /// What is recorded. Throws razor::UserError where a value is not possible, or is given without a file.
    TraceSettings settings() const;
    /// A line of the report: what a finished recorder has written.
    std::string text(const Recorder& recorder) const;

private:
    std::string file_, level_, tiles_, cores_, window_, sample_;
    std::vector<std::string> structures_, phases_;
};

} // namespace sim
