#include "sim/program/study_runs.h"

#include "razor/program/arguments.h"
#include "razor/program/study/command.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace sim {
namespace {

using analysis::plain_text;
using analysis::Point;
using analysis::Result;
using analysis::Settings;
using analysis::toml_text;
using analysis::Value;

/// Figures of a report, by JSON pointers.
struct ReportFigure {
    const char *name, *over;
};
constexpr ReportFigure report_figures[] = {
    {"cycles", "/cycles"},           {"instructions", "/core/instructions"},
    {"dram_reads", "/memory/reads"}, {"dram_writes", "/memory/writes"},
    {"l1_misses", "/l1/misses"},     {"l2_misses", "/l2/misses"},
    {"row_hits", "/memory/row_hits"}};
/// Of which points are compared with their reference: relative errors, but of rates their difference.
constexpr const char* compared[] = {"cycles", "dram_bytes", "l1_miss_rate", "l2_miss_rate"};

std::string wrong_parameter(const Parameter& p, Value& value) {
    Config any;
    if (std::holds_alternative<RealKind>(p.kind))
        if (const auto* const whole = std::get_if<std::int64_t>(&value))
            value = static_cast<double>(*whole);
    if (const auto* const whole = std::get_if<std::int64_t>(&value))
        return set_integer(p, any, *whole);
    if (const auto* const real = std::get_if<double>(&value))
        return set_real(p, any, *real);
    if (const auto* const text = std::get_if<std::string>(&value))
        return set_text(p, any, *text);
    return fmt::format("{} is no flag; write a number or a text in quotes", p.key);
}

std::string wrong_setting(std::string_view key, Value& value) {
    if (const auto wrong = razor::wrong_scene_setting(key, value))
        return *wrong;
    if (key == "machine")
        return razor::wrong_word(key, value, {});
    if (key == "workers" || key == "host_threads")
        return razor::wrong_whole(key, value, 1, key == "workers" ? 65536 : 1024);
    if (const Parameter* const p = find_parameter(key)) {
        const std::string wrong = wrong_parameter(*p, value);
        return wrong.empty() || wrong.find(';') != std::string::npos ? wrong
                                                                     : wrong + "; write another value";
    }
    if (key.find('.') != std::string_view::npos)
        return fmt::format("unknown setting {}; did you mean {}?", key, nearest_key(key));
    return razor::unknown_setting(key, run_keys());
}

double number_at(const nlohmann::ordered_json& json, const char* pointer) {
    return razor::pointed_numbers(json, pointer).front();
}

double rate(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

/// What a report says that does not depend on the host.
void add_values(analysis::Samples& values, const nlohmann::ordered_json& json) {
    for (const ReportFigure& figure : report_figures)
        if (json.contains(nlohmann::ordered_json::json_pointer(figure.over)))
            values[figure.name].push_back(number_at(json, figure.over));
    double line = 0; // of the last level, whose lines are the memory's
    for (const auto& [name, level] : json.at("machine").items())
        if (name.size() == 2 && name[0] == 'l' && level.contains("line_bytes") &&
            level.value("size_bytes", 0.0) > 0)
            line = level.at("line_bytes").get<double>();
    values["dram_bytes"].push_back(line *
                                   (number_at(json, "/memory/reads") + number_at(json, "/memory/writes")));
    for (const char* level : {"l1", "l2"}) {
        const std::string at = fmt::format("/{}/", level);
        if (!json.contains(nlohmann::ordered_json::json_pointer(at + "misses")))
            continue;
        const auto count = [&](const char* what) { return number_at(json, (at + what).c_str()); };
        values[fmt::format("{}_miss_rate", level)].push_back(
            rate(count("misses"), count("reads") + count("writes")));
    }
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

const std::vector<std::string_view>& run_keys() {
    static const std::vector<std::string_view> keys{"machine", "workers", "host_threads"};
    return keys;
}

razor::StudyProgram machine_study_program() {
    razor::StudyProgram out;
    out.name = fmt::format("razor-sim {}", razor::version());
    out.figures = {{"host_seconds", "host, s"},
                   {"host_processor_seconds", "host, processor seconds"},
                   {"instructions_per_second", "simulated instructions a second of the host"},
                   {"cycles", "cycles"},
                   {"cycles_error", "error of cycles, relative"},
                   {"cycles_deviation", "cycles beside the reference's, with its sign"},
                   {"instructions", "instructions"},
                   {"dram_bytes", "bytes from and to DRAM"},
                   {"dram_bytes_error", "error of bytes from and to DRAM, relative"},
                   {"dram_reads", "lines read from DRAM"},
                   {"dram_writes", "lines written to DRAM"},
                   {"row_hits", "row hits"},
                   {"l1_misses", "misses of L1s"},
                   {"l1_miss_rate", "misses of L1s, of all accesses"},
                   {"l1_miss_rate_error", "error of the L1s' miss rate, absolute"},
                   {"l2_misses", "misses of L2s"},
                   {"l2_miss_rate", "misses of L2s, of all accesses"},
                   {"l2_miss_rate_error", "error of the L2s' miss rate, absolute"}};
    out.vocabulary.kind = "machine";
    out.vocabulary.wrong = wrong_setting;
    for (const analysis::Figure& figure : out.figures)
        out.vocabulary.figures.push_back(figure.name);
    out.plots = {{"host_processor_seconds", "cycles_error", {}}};
    out.remarks = {
        "Errors are beside the mean of the reference's runs. Runs of a point differ in sim.jitter alone: "
        "errors below what that moves mean nothing."};
    return out;
}

MachineStudy::MachineStudy(const analysis::Study& study, std::filesystem::path folder, std::string program,
                           const std::atomic<bool>& stop)
    : study_(study), folder_(std::move(folder)), program_(std::move(program)), stop_(stop) {}

std::vector<std::string> MachineStudy::command(const Settings& settings, int seed,
                                               const std::string& json) const {
    std::vector<std::string> out{program_,           "run",    "--quiet", "--no-native",
                                 "--no-calibration", "--json", json};
    const auto add = [&](std::string_view option, std::string value) {
        out.emplace_back(option);
        out.push_back(std::move(value));
    };
    for (const auto& setting : settings) {
        const std::string& key = setting.first; // lambdas of clang take no structured bindings
        const Value& value = setting.second;
        const auto& knobs = razor::scene_knobs();
        const auto knob = std::find_if(knobs.begin(), knobs.end(),
                                       [&](const razor::SceneKnob& one) { return one.key == key; });
        if (key == "scene" || key == "machine")
            add("--" + key, (folder_ / plain_text(value)).string());
        else if (key == "workers")
            add("--workers", plain_text(value));
        else if (key == "host_threads")
            add("--host-threads", plain_text(value));
        else if (knob == knobs.end())
            add("-g", fmt::format("{}={}", key, plain_text(value)));
        else if (knob->kind != razor::SceneKnob::flag)
            add(knob->option, plain_text(value));
        else if (std::get<bool>(value))
            out.emplace_back(knob->option);
    }
    if (seed > 0)
        add("--jitter", fmt::format("{}", seed));
    return out;
}

std::string MachineStudy::own_body(const Settings& settings, int seeds) const {
    std::vector<std::string> overrides;
    const auto machine = settings.find("machine");
    if (machine == settings.end())
        throw razor::UserError("there is no machine; write machine = \"FILE\" under [settings]");
    for (const auto& [key, value] : settings)
        if (find_parameter(key) != nullptr)
            overrides.push_back(fmt::format("{}={}", key, plain_text(value)));
    const MachineDescription described =
        describe_machine((folder_ / plain_text(machine->second)).string(), overrides);
    const razor::SceneDescription scene = razor::describe_scene(settings, folder_);
    // Marks and comments of the machine's file do not change what is measured.
    std::string config = print_machine(described.config);
    Settings known = razor::with_defaults(settings, scene);
    known.erase("machine");
    known.erase("host_threads"); // changes no digit but the host's
    const auto threads = settings.find("host_threads");
    return fmt::format(
        "# A point of razor-sim study.\nkind = \"machine\"\nprogram = {}\nscene_digest = {}\nseeds = {}\n"
        "repeats = {}\nhost_threads = {}\n\n[settings]\n{}\n# the machine\n{}",
        toml_text(Value(machine_study_program().name)),
        toml_text(Value(razor::scene_digest(settings, folder_, scene))), seeds, study_.repeats,
        threads == settings.end() ? "1" : plain_text(threads->second), toml_text(known), config);
}

Point MachineStudy::reference_of(const Point& point) const {
    Point out;
    out.settings = analysis::overlaid(point.settings, study_.reference);
    out.body = own_body(out.settings, study_.reference_seeds);
    out.name = analysis::point_name(out.body);
    return out;
}

std::string MachineStudy::body(const Point& point) const {
    const std::string own = own_body(point.settings, study_.seeds);
    return study_.reference.empty() ? own
                                    : fmt::format("{}\n# compared with {}\n", own, reference_of(point).name);
}

std::vector<Point> MachineStudy::references(const std::vector<Point>& points) const {
    std::vector<Point> out;
    std::set<std::string> known;
    if (!study_.reference.empty())
        for (const Point& point : points)
            if (Point one = reference_of(point); known.insert(one.name).second)
                out.push_back(std::move(one));
    return out;
}

Result MachineStudy::run_all(const Settings& settings, int seeds) const {
    Result out;
    for (int seed = 1; seed <= seeds; ++seed)
        for (int repeat = 0; repeat < std::max(study_.repeats, 1); ++repeat) {
            const razor::ScratchFolder folder;
            const std::string json = (folder / "report.json").string();
            // One run alone is as the machine's file says; several differ by noise.
            razor::run_command(command(settings, seeds == 1 ? 0 : seed, json), folder / "log", stop_);
            const nlohmann::ordered_json report = razor::read_figures(json, "razor-sim run");
            out.host["host_seconds"].push_back(number_at(report, "/host/seconds"));
            out.host["host_processor_seconds"].push_back(number_at(report, "/host/processor_seconds"));
            out.host["instructions_per_second"].push_back(number_at(report, "/host/instructions_per_second"));
            if (repeat == 0)
                add_values(out.values, report);
        }
    return out;
}

Result MachineStudy::measure_reference(const Point& reference) const {
    return run_all(reference.settings, study_.reference_seeds);
}

Result MachineStudy::measure(const Point& point, const analysis::Store& store) const {
    Result out = run_all(point.settings, study_.seeds);
    if (study_.reference.empty())
        return out;
    const Point reference = reference_of(point);
    const auto right = store.read_result(reference);
    if (!right || !right->failed.empty())
        throw razor::UserError(fmt::format("its reference {} failed: {}", reference.name,
                                           right ? right->failed : "it has not been measured"));
    for (const std::string figure : compared) {
        const auto own = out.values.find(figure);
        const auto truth = right->values.find(figure);
        if (own == out.values.end() || truth == right->values.end())
            continue;
        const double expected = mean_of(truth->second);
        const bool relative = figure.find("rate") == std::string::npos;
        for (const double value : own->second) {
            const double off = relative ? value / expected - 1 : value - expected;
            out.values[figure + "_error"].push_back(std::abs(off));
            if (figure == "cycles")
                out.values["cycles_deviation"].push_back(off);
        }
    }
    return out;
}

} // namespace sim
