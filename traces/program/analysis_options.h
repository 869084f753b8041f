// What all analyses of razor-trace are told: which trace, which of its references, lines of which size, and
// where results go.
#pragma once

#include "analysis/traces/table.h"
#include "analysis/traces/touches.h"
#include "traces/formats/format.h"
#include "traces/io/sink.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// What stands between commas. Throws Error, which begins with `option`, where that is nothing.
std::vector<std::string> split(std::string_view option, const std::string& text);
/// A whole number. Throws Error likewise.
std::uint64_t parse_count(std::string_view option, std::string_view text, std::uint64_t least,
                          std::uint64_t most);
/// "4KiB", or "64" in bytes: a whole number and B, KiB, MiB, GiB or TiB. Throws Error, which begins with
/// `option`.
std::uint64_t parse_size(std::string_view option, std::string_view text);
/// "1KiB..1MiB" (doubling), "3KiB,5KiB", or both; ascending and different.
std::vector<std::uint64_t> parse_sizes(std::string_view option, const std::string& text);

/// A number of units of the trace's time. Throws Error likewise.
std::uint64_t parse_window(std::string_view option, std::string_view text);
/// Lines of each size, which is a multiple of a line's. Throws Error likewise.
std::vector<std::uint64_t> lines_of(std::string_view option, const std::vector<std::uint64_t>& sizes,
                                    std::uint64_t line_bytes);
/// Of something that may be none.
inline double part(std::uint64_t some, std::uint64_t all) {
    return all == 0 ? 0 : static_cast<double>(some) / static_cast<double>(all);
}

class AnalysisOptions {
public:
    /// `by`: what references are told apart by without --by; null: there is no such option. `draws`: with
    /// --svg.
    void add_to(CLI::App& app, const char* by, bool draws);
    /// References are told apart by tiles of the picture, without an option.
    void always_by_tile() { by_names_ = "tile"; }
    /// Other kinds than Touches::demand count without --kinds.
    void count_without_option(const analysis::Touches::Kinds& kinds) { kinds_in_ = kinds; }
    /// What is told is not of lines: there is no --line, and no `line_bytes` in --json.
    void without_lines() { lines_ = false; }
    /// Visits all blocks. Throws Error, Interrupted.
    void each_block(const std::function<void(const Block&)>& visit);

    /// Set by prepare(): the trace is open, its description known.
    const Description& description() const { return description_; }
    analysis::Touches touches() const;
    std::uint64_t line_bytes() const { return line_bytes_; }
    /// After prepare(): lines are something else than the trace's, a power of two of bytes.
    void take_lines_of(std::uint64_t bytes) {
        lines_ = true;
        line_bytes_ = bytes;
    }
    bool grouped() const { return !by_.empty(); }
    std::size_t by_columns() const { return by_.size(); }
    /// "structure", or "structure and phase".
    std::string by() const;
    /// With a column for each that references are told apart by first.
    analysis::Table table(std::initializer_list<const char*> columns) const;
    /// Adds a row of a group.
    void add_row(analysis::Table& table, const analysis::Touches& touches, std::size_t group,
                 std::vector<analysis::Table::Cell> cells) const;
    /// Opens the trace and checks all options. `outputs`, `inputs`: what is written and read besides.
    void prepare(const std::vector<std::string>& outputs = {}, std::vector<std::string> inputs = {});
    /// After prepare(), where the trace is read twice. Throws Error.
    void refuse_pipe() const;
    /// Opens the trace again, after each_block() has read it. Throws Error.
    void reopen() { open(); }
    const std::string& file() const { return file_; }
    const std::string& note() const { return note_; }
    /// After prepare(), where tiles of the picture are asked for. Throws Error.
    void require_tiles() const;
    /// After prepare(), where a sample of lines tells nothing. Throws Error, which ends with `mend`.
    void refuse_sample(std::string_view mend = "record all lines") const;
    /// For headings of what holds for a sample too, counts being the sample's: ", a sample of 0.1 of all
    /// lines", or nothing.
    std::string of_sample() const;
    /// Prints the table, or writes it as asked, with `files` besides; what the trace lacks is said.
    /// `draw`: makes the chart of --svg, an element.
    void give(std::string_view command, const analysis::Table& table, const std::string& heading,
              const std::function<std::string()>& draw = nullptr, std::vector<OutputFile> files = {}) const;

private:
    void open();

    std::string file_, from_, line_, kinds_, by_names_, window_, tile_, csv_, json_, svg_;
    analysis::Touches::Kinds kinds_in_ = analysis::Touches::demand;
    std::vector<analysis::By> by_; // without `all`
    std::uint64_t window_length_ = 1;
    std::uint32_t only_tile_ = 0; // of the picture; 0: all
    bool lines_ = true;
    std::uint64_t line_bytes_ = 64;
    std::unique_ptr<Input> input_;
    Description description_;
    std::string note_;
};

} // namespace traces
