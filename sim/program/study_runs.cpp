#include "sim/program/study_runs.h"

#include "analysis/study/error.h"
#include "razor/program/arguments.h"
#include "razor/program/study/command.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "razor/scene/ranges.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "sim/program/estimates.h"
#include "sim/program/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
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
    if (const auto* const text = std::get_if<std::string>(&value)) {
        const std::string wrong = set_text(p, any, *text);
        // "64 KiB" is the number, so that equal settings are equal values and have an order.
        if (const auto* const whole = std::get_if<IntegerKind>(&p.kind); whole != nullptr && wrong.empty())
            value = std::int64_t{whole->at(any)};
        return wrong;
    }
    return fmt::format("{} is no flag; write a number or a text in quotes", p.key);
}

/// Of a text that an option of `razor-sim run` takes.
std::string wrong_text(std::string_view key, const Value& value,
                       const std::function<void(const std::string&)>& parse) {
    if (const std::string wrong = razor::wrong_word(key, value, {}); !wrong.empty())
        return wrong;
    try {
        parse(std::get<std::string>(value));
    } catch (const razor::UserError& error) {
        return error.what();
    }
    return "";
}

std::string wrong_setting(std::string_view key, Value& value) {
    if (const auto wrong = razor::wrong_scene_setting(key, value))
        return *wrong;
    if (key == "machine")
        return razor::wrong_word(key, value, {});
    if (key == "workers" || key == "host_threads")
        return razor::wrong_whole(key, value, 1, key == "workers" ? 65536 : 1024);
    if (key == "frames")
        return razor::wrong_whole(key, value, 1, 1000);
    if (key == "seed")
        return razor::wrong_whole(key, value, razor::seed_range.least, razor::seed_range.most);
    if (key == "tiles")
        return wrong_text(key, value, [](const std::string& text) {
            razor::parse_span("tiles", text, {0, 1e9});
        });
    if (key == "memory")
        return wrong_text(key, value, [](const std::string& text) { razor::parse_bytes("memory", text); });
    if (key == "estimate")
        return wrong_text(key, value, [](const std::string& text) {
            if (text != "none" && text != "closed-form")
                parse_sampling("estimate", text);
        });
    if (key == "share")
        return "share is kdtree.share among the settings of machines; write that";
    if (key == "jitter" || key == "sim.jitter")
        return fmt::format("{} is what the runs of a point differ in; write seeds = N above the tables", key);
    if (const Parameter* const p = find_parameter(key)) {
        const std::string wrong = wrong_parameter(*p, value);
        return wrong.empty() || wrong.find(';') != std::string::npos ? wrong
                                                                     : wrong + "; write another value";
    }
    if (key.find('.') != std::string_view::npos)
        return fmt::format("unknown setting {}; did you mean {}?", key, nearest_key(key));
    return razor::unknown_setting(key, run_keys());
}

/// Of a setting that a study's point leaves to its machine's file.
double machine_number(const Settings& point, std::string_view key, const std::string& study) {
    const Parameter* const p = find_parameter(key);
    if (p == nullptr && key.find('.') != std::string_view::npos)
        throw analysis::StudyError(
            fmt::format("unknown setting {}; did you mean {}?", key, nearest_key(key)));
    const auto machine = point.find("machine");
    if (p == nullptr || machine == point.end())
        throw analysis::StudyError(
            fmt::format("the study does not say {}; write it into [settings] or [knobs]", key));
    const std::string file =
        (std::filesystem::path(study).parent_path() / plain_text(machine->second)).string();
    std::vector<std::string> chosen; // what the point sets that sets others, as a preset of memory does
    for (const auto& [name, value] : point)
        if (const Parameter* const set = find_parameter(name); set != nullptr && sets_others(*set))
            chosen.push_back(fmt::format("{}={}", name, plain_text(value)));
    static std::map<std::pair<std::string, std::vector<std::string>>, Config>
        read; // points share few of them
    auto found = read.find({file, chosen});
    if (found == read.end())
        found = read.emplace(std::pair{file, chosen}, read_machine(file, chosen)).first;
    Config config = found->second; // parameters are read by what could change them
    if (const auto* const whole = std::get_if<IntegerKind>(&p->kind))
        return static_cast<double>(whole->at(config));
    if (const auto* const real = std::get_if<RealKind>(&p->kind))
        return real->at(config);
    throw analysis::StudyError(fmt::format("{} is no number; leave points out by it with [[exclude]]", key));
}

double number_at(const nlohmann::ordered_json& json, const char* pointer) {
    return razor::pointed_numbers(json, pointer).front();
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

const std::vector<std::string_view>& run_keys() {
    static const std::vector<std::string_view> keys{"machine", "workers", "host_threads", "frames",
                                                    "tiles",   "memory",  "seed",         "estimate"};
    return keys;
}

razor::StudyProgram machine_study_program() {
    razor::StudyProgram out;
    out.name = fmt::format("razor-sim {}", razor::version());
    out.figures = {{"host_seconds", "host, s"},
                   {"host_processor_seconds", "host, processor seconds"},
                   {"instructions_per_second", "simulated instructions a second of the host", true},
                   {"cycles_error", "error of cycles, relative"},
                   {"cycles_deviation", "cycles beside the reference's, with its sign"},
                   {"dram_bytes_error", "error of bytes from and to DRAM, relative"},
                   {"l1_miss_rate_error", "error of the L1s' miss rate, absolute"},
                   {"l2_miss_rate_error", "error of the L2s' miss rate, absolute"}};
    out.figures.insert(out.figures.end(), report_figures().begin(), report_figures().end());
    out.vocabulary.kind = "machine";
    out.vocabulary.wrong = wrong_setting;
    out.vocabulary.preset = machine_number;
    out.name_figures();
    out.views.plots = {{"host_processor_seconds", "cycles_error", {}}};
    out.remarks = {
        "Errors are beside the mean of the reference's runs. Runs of a point differ in sim.jitter alone: "
        "errors below what that moves mean nothing."};
    return out;
}

razor::StudyProgram sweep_program() {
    razor::StudyProgram out;
    out.name = machine_study_program().name;
    out.figures = report_figures();
    out.figures.push_back({"host_seconds", "host, s"});
    out.figures.push_back({"host_processor_seconds", "host, processor seconds"});
    out.vocabulary.kind = "sweep";
    out.vocabulary.wrong = wrong_setting;
    out.vocabulary.preset = machine_number;
    out.name_figures();
    out.views = {
        {{"seconds", "energy_joules", {}}}, {"cycles", "dram_bytes", "energy_joules"}, true, {"limited_by"}};
    out.remarks = {
        "Runs of a design differ in sim.jitter alone (seeds 1 to N): designs whose runs overlap are not told "
        "apart."};
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
        else if (key == "estimate") {
            if (plain_text(value) != "none") {
                add("--estimate", plain_text(value));
                add("--estimate-seed", fmt::format("{}", std::max(seed, 1)));
            }
        } else if (key == "host_threads")
            add("--host-threads", plain_text(value));
        else if (std::find(run_keys().begin(), run_keys().end(), key) != run_keys().end())
            add("--" + key, plain_text(value));
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

const MachineStudy::Described& MachineStudy::described(const Settings& settings) const {
    Settings own; // of the scene: hundreds of machines render one
    for (const razor::SceneKnob& knob : razor::scene_knobs())
        if (const auto found = settings.find(std::string(knob.key)); found != settings.end())
            own.insert(*found);
    const std::string text = toml_text(own);
    if (const auto found = described_.find(text); found != described_.end())
        return found->second;
    const razor::SceneDescription scene = razor::describe_scene(own, folder_);
    return described_
        .emplace(text, Described{razor::scene_digest(own, folder_, scene), razor::with_defaults(own, scene)})
        .first->second;
}

std::string MachineStudy::own_body(const Settings& settings, int seeds) const {
    std::vector<std::string> overrides;
    const auto machine = settings.find("machine");
    if (machine == settings.end())
        throw razor::UserError("there is no machine; write machine = \"FILE\" under [settings]");
    for (const auto& [key, value] : settings)
        if (find_parameter(key) != nullptr)
            overrides.push_back(fmt::format("{}={}", key, plain_text(value)));
    const MachineDescription machine_description =
        describe_machine((folder_ / plain_text(machine->second)).string(), overrides);
    const Described& scene = described(settings);
    // Marks and comments of the machine's file do not change what is measured.
    std::string config = print_machine(machine_description.config);
    Settings known = analysis::overlaid(scene.settings, settings);
    known.erase("machine");
    known.erase("host_threads"); // changes no digit but the host's
    const auto threads = settings.find("host_threads");
    return fmt::format(
        "# A point of razor-sim study.\nkind = \"machine\"\nprogram = {}\nscene_digest = {}\nseeds = {}\n"
        "repeats = {}\nhost_threads = {}\n\n[settings]\n{}\n# the machine\n{}",
        toml_text(Value(machine_study_program().name)), toml_text(Value(scene.digest)), seeds, study_.repeats,
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

void MachineStudy::run(const std::vector<std::string>& words, const std::filesystem::path& log) const {
    try {
        razor::run_command(words, log, stop_);
    } catch (const razor::UserError& error) {
        // Why a point fails is told alike wherever the program lies.
        std::string what = error.what();
        if (what.starts_with(program_))
            what.replace(0, program_.size(), "razor-sim run");
        throw razor::UserError(what);
    }
}

Result MachineStudy::run_all(const Settings& settings, int seeds) const {
    Result out;
    std::map<std::string, int> limiters; // how many runs each limits
    for (int seed = 1; seed <= seeds; ++seed)
        for (int repeat = 0; repeat < std::max(study_.repeats, 1); ++repeat) {
            const razor::ScratchFolder folder;
            const std::string json = (folder / "report.json").string();
            // One run alone is as the machine's file says; several differ by noise.
            run(command(settings, seeds == 1 ? 0 : seed, json), folder / "log");
            const nlohmann::ordered_json report = razor::read_figures(json, "razor-sim run");
            out.host["host_seconds"].push_back(number_at(report, "/host/seconds"));
            out.host["host_processor_seconds"].push_back(number_at(report, "/host/processor_seconds"));
            out.host["instructions_per_second"].push_back(number_at(report, "/host/instructions_per_second"));
            if (repeat == 0)
                add_figures(out.values, report);
            if (repeat == 0)
                ++limiters[limiter_name(report)];
        }
    const auto most = std::max_element(limiters.begin(), limiters.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    out.details = nlohmann::ordered_json::object();
    out.details["limited_by"] = most->first;
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
