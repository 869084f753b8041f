#include "sim/program/trace_options.h"

#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "traces/formats/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

namespace sim {
namespace {

constexpr razor::Range any_number{0, 2147483647};

TraceSettings::Span span(const char* option, const std::string& text) {
    if (text.empty())
        return {};
    const auto [first, last] = razor::parse_span(option, text, any_number);
    return {static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last)};
}

/// "20000:30000", cycles of which the second is left out.
std::pair<std::uint64_t, std::uint64_t> window(const std::string& text) {
    const auto cycle = [&](std::string_view part) {
        std::int64_t out = -1;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), out);
        if (error != std::errc() || end != part.data() + part.size() || out < 0)
            throw razor::UserError(fmt::format(
                "--trace-window '{}' is not possible; give BEGIN:END, cycles from 0 to {}, for example 0:9",
                razor::printable(text), std::numeric_limits<std::int64_t>::max()));
        return static_cast<std::uint64_t>(out);
    };
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string_view all = text;
    const std::pair out(cycle(all.substr(0, colon)), cycle(all.substr(std::min(colon + 1, all.size()))));
    if (out.first > out.second)
        throw razor::UserError(
            fmt::format("--trace-window {}: ends before it begins; give BEGIN:END, in this order", text));
    if (out.first == out.second)
        throw razor::UserError(
            fmt::format("--trace-window {}: holds no cycle; END is left out, give a later one", text));
    return out;
}

} // namespace

void TraceOptions::add_to(CLI::App& app) {
    app.add_option("--trace", file_,
                   "record memory references; compressed if the name ends in .gz, .xz or .zst; "
                   "razor-trace reads it")
        ->type_name("FILE");
    app.add_option("--trace-level", level_,
                   "what is recorded: core (what cores ask of L1s), l1, l2, ... (what that level misses, "
                   "prefetches, writes back and through), dram (what memory is asked for); without it, core")
        ->type_name("LEVEL");
    app.add_option("--trace-structure", structures_,
                   "record references to this data structure alone; may be given more than once")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    app.add_option("--trace-phase", phases_,
                   "record references of this phase alone; may be given more than once")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    app.add_option("--trace-tiles", tiles_, "record these tiles of the chip alone, numbered from 0")
        ->type_name("FIRST..LAST");
    app.add_option("--trace-cores", cores_,
                   "record these cores alone, numbered from 0 through the whole chip; of levels core and l1")
        ->type_name("FIRST..LAST");
    app.add_option(
           "--trace-window", window_,
           "record these cycles alone, counted from where the report begins to count; END is left out")
        ->type_name("BEGIN:END");
    app.add_option("--trace-sample", sample_,
                   "record this fraction of all lines alone, each of them always or never; without it, 1")
        ->type_name("FRACTION");
}

TraceSettings TraceOptions::settings() const {
    const auto needs_file = [](const char* option, bool given) {
        if (given)
            throw razor::UserError(fmt::format("{} is of no use without --trace FILE; give both", option));
    };
    if (!wanted()) {
        needs_file("--trace-level", !level_.empty());
        needs_file("--trace-structure", !structures_.empty());
        needs_file("--trace-phase", !phases_.empty());
        needs_file("--trace-tiles", !tiles_.empty());
        needs_file("--trace-cores", !cores_.empty());
        needs_file("--trace-window", !window_.empty());
        needs_file("--trace-sample", !sample_.empty());
    }
    if (wanted())
        traces::check_own_name(file_);
    TraceSettings s;
    if (!level_.empty())
        s.level = level_;
    s.structures = structures_;
    s.phases = phases_;
    s.tiles = span("--trace-tiles", tiles_);
    s.cores = span("--trace-cores", cores_);
    if (!window_.empty())
        std::tie(s.begin, s.end) = window(window_);
    if (!sample_.empty())
        s.sample = razor::parse_number("--trace-sample", sample_, {1e-6, 1});
    return s;
}

std::string TraceOptions::text(const Recorder& recorder) const {
    return fmt::format("trace: {} references in {} bytes, {:.2f} bytes each before further compression\n",
                       recorder.references(), recorder.bytes(),
                       static_cast<double>(recorder.bytes()) /
                           static_cast<double>(std::max<std::uint64_t>(1, recorder.references())));
}

} // namespace sim
