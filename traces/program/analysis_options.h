// What all analyses of razor-trace are told: which trace, which of its references, lines of which size, and
// where results go.
#pragma once

#include "analysis/traces/table.h"
#include "analysis/traces/touches.h"
#include "traces/formats/format.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// "4KiB", or "64" in bytes: a whole number and B, KiB, MiB, GiB or TiB. Throws Error, which begins with
/// `option`.
std::uint64_t parse_size(std::string_view option, std::string_view text);
/// "1KiB..1MiB" (doubling), "3KiB,5KiB", or both; ascending and different.
std::vector<std::uint64_t> parse_sizes(std::string_view option, const std::string& text);

class AnalysisOptions {
public:
    /// `grouped`: with --by.
    void add_to(CLI::App& app, bool grouped);
    /// Visits all blocks. Throws Error, Interrupted.
    void each_block(const std::function<void(const Block&)>& visit);

    /// Set by prepare(): the trace is open, its description known.
    const Description& description() const { return description_; }
    analysis::Touches touches() const;
    std::uint64_t line_bytes() const { return line_bytes_; }
    bool grouped() const { return by_ != analysis::By::all; }
    const char* by() const { return analysis::by_names[static_cast<std::size_t>(by_)]; }
    /// Opens the trace and checks all options.
    void prepare();
    /// Prints the table, or writes it as asked; what the trace lacks is said.
    void give(std::string_view command, const analysis::Table& table, const std::string& heading) const;

private:
    std::string file_, from_, line_, kinds_, by_name_ = "all", csv_, json_;
    analysis::Touches::Kinds kinds_in_ = analysis::Touches::demand;
    analysis::By by_ = analysis::By::all;
    std::uint64_t line_bytes_ = 64;
    std::unique_ptr<Input> input_;
    Description description_;
    std::string note_;
};

} // namespace traces
