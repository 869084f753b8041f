#include "traces/program/study_runs.h"

#include "analysis/study/error.h"
#include "analysis/traces/estimators.h"
#include "analysis/traces/touches.h"
#include "razor/program/study/checks.h"
#include "traces/error.h"
#include "traces/formats/format.h"
#include "traces/program/analysis_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>
#include <set>
#include <span>
#include <sys/stat.h>

namespace traces {
namespace {

using analysis::plain_text;
using analysis::Point;
using analysis::Result;
using analysis::Settings;
using analysis::toml_text;
using analysis::Value;

struct TraceSetting {
    const char *key, *meaning;
};
constexpr TraceSetting trace_settings[] = {
    {"trace", "a trace of any format, a file; named from the study's folder"},
    {"from", "its format; without it, as it begins or is named"},
    {"line_bytes", "of lines; without it, those of the trace, or 64"},
    {"sizes", "of caches, as \"1KiB..16MiB\" (which it is without it); those count up to the first that has "
              "the least misses of all"},
    {"ways", "of caches, which are LRU; 0, or without it: fully associative"},
    {"method", "what is looked at: exact (all), lines (a sample: SHARDS), windows (of time), sets (of each "
               "cache)"},
    {"share", "of lines, windows or sets, above 0, at most 1"},
    {"most_lines", "lines: at most so many (SHARDS of a fixed size, at least 256); 0, or without it: any"},
    {"window", "windows: touches of one; without it 100000"},
    {"start", "windows: what caches hold at their beginning: \"kept\" of the window before, as without it, "
              "or \"empty\""},
    {"warm_up", "windows: at their beginning this part is not counted; without it 0"}};
constexpr std::uint64_t least_sample = 256; // lines
constexpr std::size_t most_at_once = 65536; // touches, before it looks whether to stop

std::string wrong_sizes(const Value& value) {
    if (const std::string wrong = razor::wrong_word("sizes", value, {}); !wrong.empty())
        return wrong;
    try {
        parse_sizes("sizes", std::get<std::string>(value));
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string wrong_setting(std::string_view key, Value& value) {
    if (key == "trace" || key == "from")
        return razor::wrong_word(key, value, {});
    if (key == "sizes")
        return wrong_sizes(value);
    if (key == "line_bytes") {
        const std::string wrong = razor::wrong_whole(key, value, 1, 65536);
        const bool power =
            wrong.empty() && std::has_single_bit(static_cast<std::uint64_t>(std::get<std::int64_t>(value)));
        return !wrong.empty() || power ? wrong : "line_bytes is no power of two; write 64";
    }
    if (key == "ways")
        return razor::wrong_whole(key, value, 0, 1024);
    if (key == "method")
        return razor::wrong_word(
            key, value, {analysis::sampling_method_names.begin(), analysis::sampling_method_names.end()});
    if (key == "share")
        return razor::wrong_number(key, value, 1e-6, 1);
    if (key == "most_lines") {
        const std::string wrong = razor::wrong_whole(key, value, 0, 1e9);
        const bool few = wrong.empty() && std::get<std::int64_t>(value) != 0 &&
                         std::get<std::int64_t>(value) < std::int64_t{least_sample};
        return few ? fmt::format("most_lines says too little; write at least {}", least_sample) : wrong;
    }
    if (key == "window")
        return razor::wrong_whole(key, value, 100, 1e12);
    if (key == "start")
        return razor::wrong_word(key, value, {"kept", "empty"});
    if (key == "warm_up")
        return razor::wrong_number(key, value, 0, 0.99);
    std::vector<std::string_view> keys;
    for (const TraceSetting& setting : trace_settings)
        keys.emplace_back(setting.key);
    return razor::no_setting(key, keys);
}

double seconds_of(clockid_t clock) {
    timespec now{};
    ::clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of any number of bytes: each part's name with that of all before. Throws Stopped.
std::string digest_of(Source& source, const std::atomic<bool>& stop) {
    std::string out, part;
    for (;;) {
        if (stop.load())
            throw analysis::Stopped{};
        part.resize(std::size_t{1} << 20U);
        part.resize(source.read(part.data(), part.size()));
        if (part.empty())
            return out.empty() ? analysis::point_name("") : out;
        out = analysis::point_name(out + part);
    }
}

/// Which file it is, how long, and when it was last changed; empty where there is none.
std::string stamp_of(const std::string& file) {
    struct stat s {};
    if (::stat(file.c_str(), &s) != 0)
        return "";
    return fmt::format("{} {} {} {}.{} {}.{}", s.st_dev, s.st_ino, s.st_size, s.st_mtim.tv_sec,
                       s.st_mtim.tv_nsec, s.st_ctim.tv_sec, s.st_ctim.tv_nsec);
}

std::unique_ptr<Input> open_trace(const std::string& file, const Settings& settings) {
    auto source = open_source(file);
    const auto from = settings.find("from");
    const Format& format =
        format_of_input(from == settings.end() ? "" : plain_text(from->second), file, *source);
    return format.read(std::move(source));
}

std::uint64_t whole_at(const Settings& settings, const char* key) {
    return static_cast<std::uint64_t>(std::get<std::int64_t>(settings.at(key)));
}

std::vector<std::uint64_t> sizes_of(const Settings& whole) {
    return lines_of("sizes", parse_sizes("sizes", plain_text(whole.at("sizes"))),
                    whole_at(whole, "line_bytes"));
}

analysis::SamplingMethod method_of(const Settings& whole) {
    const auto& names = analysis::sampling_method_names;
    return static_cast<analysis::SamplingMethod>(
        std::find(names.begin(), names.end(), plain_text(whole.at("method"))) - names.begin());
}

analysis::Sampling sampling_of(const Settings& whole, std::uint64_t seed) {
    analysis::Sampling out;
    out.method = method_of(whole);
    out.seed = seed;
    if (out.method != analysis::SamplingMethod::exact)
        out.share = std::get<double>(whole.at("share"));
    if (out.method == analysis::SamplingMethod::lines)
        out.most_lines = whole_at(whole, "most_lines");
    if (out.method == analysis::SamplingMethod::windows) {
        out.window = whole_at(whole, "window");
        out.keep = plain_text(whole.at("start")) == "kept";
        out.warm_up = std::get<double>(whole.at("warm_up"));
    }
    return out;
}

} // namespace

razor::StudyProgram trace_study_program() {
    razor::StudyProgram out;
    out.name = "razor-trace " RAZOR_VERSION;
    out.figures = {{"processor_seconds", "processor time, reading included, s"},
                   {"estimator_seconds", "processor time without reading, s"},
                   {"seconds", "time, reading included, s"},
                   {"touches_per_second", "touches a second, reading included", true},
                   {"estimator_touches_per_second", "touches a second, without reading", true},
                   {"mean_error", "error of miss ratios, in the mean over sizes"},
                   {"largest_error", "error of miss ratios, at the worst size"},
                   {"mean_deviation", "miss ratios beside the exact ones, with their sign, in the mean"},
                   {"looked_at", "touches that were looked at, of all"},
                   {"sizes", "sizes of caches that were compared"}};
    out.vocabulary.kind = "trace";
    out.vocabulary.wrong = wrong_setting;
    out.name_figures();
    out.views.plots = {{"processor_seconds", "mean_error", {"method"}},
                       {"estimator_seconds", "mean_error", {"method"}}};
    out.remarks = {
        "Errors are absolute, beside the exact stack distances of the same caches. Runs of a point "
        "differ in what the sample is of."};
    return out;
}

std::string trace_settings_text() {
    std::string out;
    for (const TraceSetting& setting : trace_settings)
        out += fmt::format("  {:<24} {}\n", setting.key, setting.meaning);
    return out + "Settings of methods that a point does not take count for nothing.\n";
}

TraceStudy::TraceStudy(const analysis::Study& study, std::filesystem::path folder,
                       const std::atomic<bool>& stop)
    : study_(study), folder_(std::move(folder)), stop_(stop) {
    for (const Settings& point : study.points) {
        if (point.find("trace") == point.end())
            throw Error(
                fmt::format("{}: a point has no trace; write trace = \"FILE\" under [settings]", study.file));
        const auto from = point.find("from");
        const std::string file = file_of(point).string();
        const std::string key = file + '\n' + (from == point.end() ? "" : plain_text(from->second));
        if (known_.count(key) != 0)
            continue;
        std::error_code none;
        if (!std::filesystem::is_regular_file(file, none))
            throw Error(fmt::format("{}: there is no trace {}; record it, as the study's first lines may say",
                                    study.place_of("trace", point.at("trace")), file));
        Known& one = known_[key];
        const Description about = open_trace(file, point)->description();
        if (about.sample < 1)
            throw Error(fmt::format("{}: is a sample of {:g} of all lines, beside which there is nothing "
                                    "exact; record all lines",
                                    file, about.sample));
        if (about.line_bytes != 0)
            one.line_bytes = about.line_bytes;
        one.stamp = stamp_of(file);
        one.digest = digest_of(*open_source(file), stop_);
    }
}

std::filesystem::path TraceStudy::file_of(const Settings& settings) const {
    return folder_ / plain_text(settings.at("trace"));
}

const TraceStudy::Known& TraceStudy::known(const Settings& settings) const {
    const auto from = settings.find("from");
    return known_.at(file_of(settings).string() + '\n' +
                     (from == settings.end() ? "" : plain_text(from->second)));
}

Settings TraceStudy::whole(const Settings& settings) const {
    using analysis::SamplingMethod;
    const Settings defaults{{"line_bytes", static_cast<std::int64_t>(known(settings).line_bytes)},
                            {"sizes", std::string("1KiB..16MiB")},
                            {"ways", std::int64_t{0}},
                            {"most_lines", std::int64_t{0}},
                            {"window", std::int64_t{100000}},
                            {"start", std::string("kept")},
                            {"warm_up", 0.0},
                            {"share", 1.0}};
    Settings out = analysis::overlaid(defaults, settings);
    if (out.find("method") == out.end())
        throw Error("there is no method; write method = \"lines\", or another one");
    const SamplingMethod method = method_of(out);
    if (method != SamplingMethod::lines)
        out.erase("most_lines");
    if (method != SamplingMethod::windows)
        for (const char* key : {"window", "start", "warm_up"})
            out.erase(key);
    if (method == SamplingMethod::exact)
        out.erase("share");
    return out;
}

std::string TraceStudy::own_body(const Settings& whole, int seeds) const {
    Settings settings = whole;
    settings.erase("trace"); // its bytes count, not where it lies
    return fmt::format("# A point of razor-trace study.\nkind = \"trace\"\nprogram = {}\ntrace_digest = {}\n"
                       "seeds = {}\nrepeats = {}\n\n[settings]\n{}",
                       toml_text(Value(trace_study_program().name)), toml_text(Value(known(whole).digest)),
                       seeds, study_.repeats, toml_text(settings));
}

Point TraceStudy::reference_of(const Point& point) const {
    Point out;
    out.settings = point.settings;
    out.settings["method"] = std::string("exact");
    out.body = own_body(whole(out.settings), 1) + "# exact curves, for others to be compared with\n";
    out.name = analysis::point_name(out.body);
    return out;
}

std::string TraceStudy::body(const Point& point) const {
    const Settings all = whole(point.settings);
    analysis::make_estimator(sizes_of(all), whole_at(all, "ways"), sampling_of(all, 1)); // it can be made
    return fmt::format("{}# compared with {}\n", own_body(all, study_.seeds), reference_of(point).name);
}

std::vector<Point> TraceStudy::references(const std::vector<Point>& points) const {
    std::vector<Point> out;
    std::set<std::string> known;
    for (const Point& point : points)
        if (Point one = reference_of(point); known.insert(one.name).second)
            out.push_back(std::move(one));
    return out;
}

std::string TraceStudy::changed(const Point& point) const {
    const Known& before = known(point.settings);
    const std::string file = file_of(point.settings).string();
    try {
        if (stamp_of(file) == before.stamp || digest_of(*open_source(file), stop_) == before.digest)
            return "";
    } catch (const Error&) {
        // It cannot be read any more.
    }
    return file;
}

TraceStudy::Run TraceStudy::run(const Settings& whole, std::uint64_t seed) const {
    const std::vector<std::uint64_t> sizes = sizes_of(whole);
    const auto estimator = analysis::make_estimator(sizes, whole_at(whole, "ways"), sampling_of(whole, seed));
    Run out;
    const double began = seconds_of(CLOCK_MONOTONIC), worked = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const auto input = open_trace(file_of(whole).string(), whole);
    analysis::Touches touches(static_cast<unsigned>(std::countr_zero(whole_at(whole, "line_bytes"))),
                              analysis::Touches::demand, analysis::By::all);
    std::vector<std::uint64_t> lines;
    for (Block block; input->next(block);) {
        lines.clear();
        touches.each(block, [&](const analysis::Touch& t) { lines.push_back(t.line); });
        const double before = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        for (std::size_t i = 0; i < lines.size(); i += most_at_once) {
            if (stop_.load())
                throw analysis::Stopped{};
            estimator->touch(std::span(lines).subspan(i, std::min(most_at_once, lines.size() - i)));
        }
        out.estimator_seconds += seconds_of(CLOCK_THREAD_CPUTIME_ID) - before;
        out.touches += lines.size();
    }
    if (out.touches == 0)
        throw Error("the trace holds no reads, writes or fetches; record another one");
    for (std::size_t s = 0; s < sizes.size(); ++s)
        out.ratios.push_back(estimator->ratio(s));
    out.looked_at = estimator->looked_at();
    out.seconds = seconds_of(CLOCK_MONOTONIC) - began;
    out.processor_seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - worked;
    return out;
}

Result TraceStudy::measure_reference(const Point& reference) const {
    const Settings all = whole(reference.settings);
    const Run exact = run(all, 0);
    Result out;
    out.host["processor_seconds"] = {exact.processor_seconds};
    out.details = nlohmann::ordered_json::object();
    out.details["lines"] = sizes_of(all);
    out.details["miss_ratios"] = exact.ratios;
    return out;
}

Result TraceStudy::measure(const Point& point, const analysis::Store& store) const {
    const Point reference = reference_of(point);
    const auto right = store.read_result(reference);
    if (!right || !right->failed.empty())
        throw Error(fmt::format("its reference {} failed: {}", reference.name,
                                right ? right->failed : "it has not been measured"));
    auto truth = right->details.at("miss_ratios").get<std::vector<double>>();
    // Larger caches are all alike.
    truth.resize(static_cast<std::size_t>(std::min_element(truth.begin(), truth.end()) - truth.begin()) + 1);
    const Settings all = whole(point.settings);
    Result out;
    for (int seed = 1; seed <= study_.seeds; ++seed)
        for (int repeat = 0; repeat < std::max(study_.repeats, 1); ++repeat) {
            const Run one = run(all, static_cast<std::uint64_t>(seed - 1)); // the first is the tools' own
            const auto touches = static_cast<double>(one.touches);
            out.host["seconds"].push_back(one.seconds);
            out.host["processor_seconds"].push_back(one.processor_seconds);
            out.host["estimator_seconds"].push_back(one.estimator_seconds);
            out.host["touches_per_second"].push_back(touches / one.processor_seconds);
            out.host["estimator_touches_per_second"].push_back(touches / one.estimator_seconds);
            if (repeat != 0)
                continue;
            double mean = 0, largest = 0, deviation = 0;
            for (std::size_t s = 0; s < truth.size(); ++s) {
                const double off = one.ratios[s] - truth[s];
                if (std::isnan(off))
                    throw Error("its sample has nothing to tell of some cache; take a larger share");
                mean += std::abs(off);
                deviation += off;
                largest = std::max(largest, std::abs(off));
            }
            const auto sizes = static_cast<double>(truth.size());
            out.values["mean_error"].push_back(mean / sizes);
            out.values["largest_error"].push_back(largest);
            out.values["mean_deviation"].push_back(deviation / sizes);
            out.values["looked_at"].push_back(static_cast<double>(one.looked_at) / touches);
            out.values["sizes"].push_back(sizes);
        }
    return out;
}

} // namespace traces
