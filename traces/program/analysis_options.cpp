#include "traces/program/analysis_options.h"

#include "analysis/plots/svg.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"
#include "traces/program/progress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <filesystem>
#include <sstream>

namespace traces {
namespace {

constexpr std::uint64_t most_line_bytes = std::uint64_t{1}
                                          << 30U; // of the largest pages that processors have

/// The number of `text` among `names`.
template <class Names>
std::size_t number_of(const char* option, const std::string& text, const Names& names) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        throw Error(
            fmt::format("{} {}: there is no such thing; give {}", option, text, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
}

/// The number of the tile that pixel "X,Y" lies in.
std::uint32_t parse_tile(const std::string& text, const Picture& picture) {
    std::array<std::uint32_t, 2> at{};
    const char *from = text.data(), *const end = from + text.size();
    for (std::size_t i = 0; i < at.size(); ++i) {
        const auto [next, error] = std::from_chars(from, end, at[i]);
        if (error != std::errc() || (i == 0 ? next == end || *next != ',' : next != end))
            throw Error(
                fmt::format("--tile '{}': give a pixel as X,Y, from the upper left one, 0,0, on", text));
        from = next + 1;
    }
    if (at[0] >= picture.width || at[1] >= picture.height)
        throw Error(fmt::format("--tile {}: the picture has {} x {} pixels, numbered from 0", text,
                                picture.width, picture.height));
    return picture.tile_of(at[0], at[1]);
}

} // namespace

std::vector<std::string> split(std::string_view option, const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text + ',');
    for (std::string part; std::getline(in, part, ',');) {
        if (part.empty())
            throw Error(fmt::format("{} '{}': a part is empty; give a value, and commas only between two",
                                    option, text));
        out.push_back(part);
    }
    return out;
}

std::uint64_t parse_count(std::string_view option, std::string_view text, std::uint64_t least,
                          std::uint64_t most) {
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc() || end != text.data() + text.size() || out < least || out > most)
        throw Error(fmt::format("{} '{}': give a whole number from {} to {}", option, text, least, most));
    return out;
}

std::uint64_t parse_size(std::string_view option, std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    unsigned shift = 0;
    for (const std::string_view known : {"B", "KiB", "MiB", "GiB", "TiB"}) {
        if (error == std::errc() && (unit == known || (unit.empty() && shift == 0)) && number != 0 &&
            number <= (std::uint64_t{1} << (62 - shift)))
            return number << shift;
        shift += 10;
    }
    throw Error(
        fmt::format("{} '{}': no size; give a whole number of bytes, or of KiB, MiB, GiB or TiB, as 32KiB",
                    option, text));
}

std::vector<std::uint64_t> parse_sizes(std::string_view option, const std::string& text) {
    std::vector<std::uint64_t> out;
    for (const std::string& part : split(option, text)) {
        const std::size_t dots = part.find("..");
        const std::uint64_t first = parse_size(option, part.substr(0, dots));
        const std::uint64_t last =
            dots == std::string::npos ? first : parse_size(option, part.substr(dots + 2));
        if (last < first)
            throw Error(fmt::format("{} {}: ends before it begins; turn it round", option, part));
        for (std::uint64_t size = first; size <= last; size *= 2)
            out.push_back(size);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::uint64_t parse_window(std::string_view option, std::string_view text) {
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc() || end != text.data() + text.size() || out == 0)
        throw Error(fmt::format("{} '{}': no length; give a whole number of units of the trace's time, "
                                "at least 1",
                                option, text));
    return out;
}

std::vector<std::uint64_t> lines_of(std::string_view option, const std::vector<std::uint64_t>& sizes,
                                    std::uint64_t line_bytes) {
    std::vector<std::uint64_t> out;
    for (const std::uint64_t size : sizes) {
        if (size % line_bytes != 0)
            throw Error(
                fmt::format("{} {}: lines have {} bytes; give multiples of that", option, size, line_bytes));
        out.push_back(size / line_bytes);
    }
    return out;
}

void AnalysisOptions::add_to(CLI::App& app, const char* by, bool draws) {
    app.add_option("TRACE", file_, "a trace of any format, or -")->required();
    app.add_option("--from", from_, "its format; without it, as it begins or is named")->type_name("FORMAT");
    if (lines_)
        app.add_option("--line", line_,
                       "bytes of a line, a power of two; without it, those of the trace, or 64")
            ->type_name("SIZE");
    std::string kinds;
    for (std::size_t k = 0; k < kind_names.size(); ++k)
        if (kinds_in_[k])
            kinds += (kinds.empty() ? "" : ",") + std::string(kind_names[k]);
    app.add_option("--kinds", kinds_,
                   "kinds of references that count, with commas between; without it, " + kinds)
        ->type_name("KINDS");
    if (by != nullptr) {
        by_names_ = by;
        app.add_option(
               "--by", by_names_,
               fmt::format("tell references apart by some of, with commas between: {}; without it, {}",
                           fmt::join(analysis::by_names, ", "), by))
            ->type_name("WHAT");
        app.add_option("--window", window_, "units of the trace's time a window, for --by window")
            ->type_name("N");
    }
    app.add_option("--tile", tile_,
                   "only references for the screen tile that this pixel lies in, of traces that know tiles")
        ->type_name("X,Y");
    app.add_option("--csv", csv_, "write the table for programs, whole or not at all; - is standard output")
        ->type_name("FILE");
    app.add_option("--json", json_, "likewise, with what was analysed")->type_name("FILE");
    if (draws)
        app.add_option("--svg", svg_, "draw a chart of the table")->type_name("FILE");
}

void AnalysisOptions::prepare(const std::vector<std::string>& outputs, std::vector<std::string> inputs) {
    std::vector<std::string> all{csv_, json_, svg_};
    all.insert(all.end(), outputs.begin(), outputs.end());
    inputs.push_back(file_);
    check_apart(all, inputs);
    if (!svg_.empty() && svg_ != "-" && !svg_.ends_with(".svg"))
        throw Error(fmt::format("--svg {}: name a .svg file", svg_));
    if (!kinds_.empty()) {
        kinds_in_.fill(false);
        for (const std::string& kind : split("--kinds", kinds_))
            kinds_in_[number_of("--kinds", kind, kind_names)] = true;
    }
    for (const std::string& name : split("--by", by_names_.empty() ? "all" : by_names_)) {
        const auto by = static_cast<analysis::By>(number_of("--by", name, analysis::by_names));
        if (std::find(by_.begin(), by_.end(), by) != by_.end())
            throw Error(fmt::format("--by {}: names {} twice; name it once", by_names_, name));
        if (by != analysis::By::all)
            by_.push_back(by);
    }
    const bool windows = std::find(by_.begin(), by_.end(), analysis::By::window) != by_.end();
    if (windows != !window_.empty())
        throw Error(windows ? "--by window: how long is one? give --window N"
                            : "--window: windows are not asked for; add --by window");
    if (windows)
        window_length_ = parse_window("--window", window_);
    open();
    if (!tile_.empty()) {
        require_tiles();
        only_tile_ = parse_tile(tile_, description_.picture);
    }
    if (std::find(by_.begin(), by_.end(), analysis::By::tile) != by_.end())
        require_tiles();
    if (!line_.empty()) {
        line_bytes_ = parse_size("--line", line_);
        if (line_bytes_ > most_line_bytes)
            throw Error(fmt::format("--line {}: lines have at most {} bytes here; give a shorter one", line_,
                                    most_line_bytes));
    } else if (description_.line_bytes != 0)
        line_bytes_ = description_.line_bytes;
    if (!std::has_single_bit(line_bytes_))
        throw Error(fmt::format("--line {}: no power of two", line_));
    if (description_.sample < 1 && line_bytes_ != description_.line_bytes)
        throw Error(
            fmt::format("--line {}: the trace is of a sample of lines of {} bytes, others are not whole "
                        "in it; leave --line out",
                        line_, description_.line_bytes));
}

void AnalysisOptions::open() {
    auto source = open_source(file_);
    const Format& format = format_of_input(from_, file_, *source);
    input_ = format.read(std::move(source));
    description_ = input_->description();
}

void AnalysisOptions::refuse_pipe() const {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file_, none))
        throw Error(fmt::format("{}: is read twice, and this is a pipe; write it into a file first", file_));
}

void AnalysisOptions::require_tiles() const {
    if (description_.picture.tiles() == 0)
        throw Error(fmt::format("{}: does not say for which screen tile a reference was; record it by "
                                "`razor render --trace` or `razor-sim run --trace`, and keep it as .rzt",
                                file_));
}

void AnalysisOptions::refuse_sample(std::string_view mend) const {
    if (description_.sample < 1)
        throw Error(fmt::format("{}: is a sample of {:g} of all lines, of which this cannot be told; {}",
                                file_, description_.sample, mend));
}

std::string AnalysisOptions::of_sample() const {
    return description_.sample < 1 ? fmt::format(", a sample of {:g} of all lines", description_.sample) : "";
}

analysis::Touches AnalysisOptions::touches() const {
    return {
        static_cast<unsigned>(std::countr_zero(line_bytes_)), kinds_in_, {by_, window_length_, only_tile_}};
}

std::string AnalysisOptions::by() const {
    std::string out;
    for (const analysis::By by : by_)
        out += (out.empty() ? "" : " and ") + std::string(analysis::by_names[static_cast<std::size_t>(by)]);
    return out;
}

analysis::Table AnalysisOptions::table(std::initializer_list<const char*> columns) const {
    analysis::Table out;
    for (const analysis::By by : by_)
        out.columns.emplace_back(analysis::by_names[static_cast<std::size_t>(by)]);
    out.columns.insert(out.columns.end(), columns.begin(), columns.end());
    return out;
}

void AnalysisOptions::add_row(analysis::Table& table, const analysis::Touches& touches, std::size_t group,
                              std::vector<analysis::Table::Cell> cells) const {
    table.rows.push_back(touches.cells(group, description_));
    table.rows.back().insert(table.rows.back().end(), std::make_move_iterator(cells.begin()),
                             std::make_move_iterator(cells.end()));
}

void AnalysisOptions::each_block(const std::function<void(const Block&)>& visit) {
    Progress progress;
    for (Block block; input_->next(block); progress.add(block.size())) {
        check_interrupts();
        visit(block);
    }
    description_ = input_->description(); // with all sites
    note_ = input_->note();
}

void AnalysisOptions::give(std::string_view command, const analysis::Table& table, const std::string& heading,
                           const std::function<std::string()>& draw, std::vector<OutputFile> files) const {
    if (!csv_.empty())
        files.push_back({csv_, table.csv()});
    if (!json_.empty()) {
        nlohmann::ordered_json out{{"analysis", command},
                                   {"trace", file_},
                                   {"program", description_.program},
                                   {"level", description_.level},
                                   {"sample", description_.sample}};
        if (lines_)
            out["line_bytes"] = line_bytes_;
        out["complete"] = note_.empty();
        out["note"] = note_;
        out["summary"] = heading;
        out["rows"] = nlohmann::ordered_json::parse(table.json());
        files.push_back(
            {json_, out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"});
    }
    if (!svg_.empty())
        files.push_back({svg_, analysis::svg_file(draw())});
    check_interrupts();
    write_files(files);
    if (csv_ != "-" && json_ != "-" && svg_ != "-")
        fmt::print("{}\n\n{}", heading, table.text());
    if (!note_.empty())
        fmt::print(stderr, "razor-trace: {}\n", note_);
}

} // namespace traces
