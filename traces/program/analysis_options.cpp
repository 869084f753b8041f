#include "traces/program/analysis_options.h"

#include "traces/error.h"
#include "traces/program/interrupt.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <sstream>
#include <unistd.h>

namespace traces {
namespace {

/// Of a long run, on a terminal.
class Progress {
public:
    void add(std::size_t references) {
        references_ += references;
        if (on_ && references_ - shown_ >= 4000000) {
            shown_ = references_;
            fmt::print(stderr, "\r{} million references ", references_ / 1000000);
        }
    }
    ~Progress() {
        if (on_ && shown_ != 0)
            fmt::print(stderr, "\r\x1b[K");
    }

private:
    bool on_ = isatty(STDERR_FILENO) != 0;
    std::uint64_t references_ = 0, shown_ = 0;
};

/// The number of `text` among `names`.
template <class Names>
std::size_t number_of(const char* option, const std::string& text, const Names& names) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        throw Error(
            fmt::format("{} {}: there is no such thing; give {}", option, text, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ',');)
        out.push_back(part);
    return out;
}

} // namespace

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
    for (const std::string& part : split(text)) {
        const std::size_t dots = part.find("..");
        const std::uint64_t first = parse_size(option, part.substr(0, dots));
        const std::uint64_t last =
            dots == std::string::npos ? first : parse_size(option, part.substr(dots + 2));
        if (last < first)
            throw Error(fmt::format("{} {}: ends before it begins; turn it round", option, part));
        for (std::uint64_t size = first; size <= last; size *= 2)
            out.push_back(size);
    }
    if (out.empty())
        throw Error(fmt::format("{}: no size; give some, as 1KiB..1MiB or 32KiB,48KiB", option));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

void AnalysisOptions::add_to(CLI::App& app, bool grouped) {
    app.add_option("TRACE", file_, "a trace of any format, or -")->required();
    app.add_option("--from", from_, "its format; without it, as it begins or is named")->type_name("FORMAT");
    app.add_option("--line", line_, "bytes of a line, a power of two; without it, those of the trace, or 64")
        ->type_name("SIZE");
    app.add_option("--kinds", kinds_,
                   "kinds of references that count, with commas between; without it, read,write,modify,fetch")
        ->type_name("KINDS");
    if (grouped)
        app.add_option("--by", by_name_,
                       fmt::format("tell references apart by: {}", fmt::join(analysis::by_names, ", ")))
            ->type_name("WHAT");
    app.add_option("--csv", csv_, "write the table for programs, whole or not at all; - is standard output")
        ->type_name("FILE");
    app.add_option("--json", json_, "likewise, with what was analysed")->type_name("FILE");
}

void AnalysisOptions::prepare() {
    if (!kinds_.empty()) {
        kinds_in_.fill(false);
        for (const std::string& kind : split(kinds_))
            kinds_in_[number_of("--kinds", kind, kind_names)] = true;
    }
    by_ = static_cast<analysis::By>(number_of("--by", by_name_, analysis::by_names));
    auto source = open_source(file_);
    const Format& format = format_of_input(from_, file_, *source);
    input_ = format.read(std::move(source));
    description_ = input_->description();
    if (!line_.empty())
        line_bytes_ = parse_size("--line", line_);
    else if (description_.line_bytes != 0)
        line_bytes_ = description_.line_bytes;
    if (!std::has_single_bit(line_bytes_))
        throw Error(fmt::format("--line {}: no power of two", line_));
    if (description_.sample < 1 && line_bytes_ != description_.line_bytes)
        throw Error(
            fmt::format("--line {}: the trace is of a sample of lines of {} bytes, others are not whole "
                        "in it; leave --line out",
                        line_, description_.line_bytes));
}

analysis::Touches AnalysisOptions::touches() const {
    return {static_cast<unsigned>(std::countr_zero(line_bytes_)), kinds_in_, by_};
}

void AnalysisOptions::each_block(const std::function<void(const Block&)>& visit) {
    Progress progress;
    for (Block block; input_->next(block); progress.add(block.size())) {
        if (interrupted())
            throw Interrupted();
        visit(block);
    }
    description_ = input_->description(); // with all sites
    note_ = input_->note();
}

void AnalysisOptions::give(std::string_view command, const analysis::Table& table,
                           const std::string& heading) const {
    const auto write = [](const std::string& file, const std::string& text) {
        const std::unique_ptr<Sink> sink = open_sink(file);
        sink->write(text);
        sink->commit();
    };
    if (!csv_.empty())
        write(csv_, table.csv());
    if (!json_.empty()) {
        nlohmann::ordered_json out{{"analysis", command},
                                   {"trace", file_},
                                   {"program", description_.program},
                                   {"level", description_.level},
                                   {"sample", description_.sample},
                                   {"line_bytes", line_bytes_},
                                   {"complete", note_.empty()},
                                   {"note", note_},
                                   {"summary", heading}};
        out["rows"] = nlohmann::ordered_json::parse(table.json());
        write(json_, out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    }
    if (csv_ != "-" && json_ != "-")
        fmt::print("{}\n\n{}", heading, table.text());
    if (!note_.empty())
        fmt::print(stderr, "razor-trace: {}\n", note_);
}

} // namespace traces
