#include "sim/program/study_runs.h"

#include "analysis/study/error.h"
#include "razor/program/study/command.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "sim/estimate/seed.h"
#include "sim/program/report_figures.h"
#include "sim/program/study_program.h"

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

/// Of which points are compared with their reference: relative errors, but of rates their difference.
constexpr const char* compared[] = {"cycles", "dram_bytes", "l1_miss_rate", "l2_miss_rate"};

/// In a point's body, before its machine.
constexpr std::string_view machine_title = "# the machine\n";
/// Throws ConfigError.
Config machine_in(std::string_view body) {
    return parse_machine(std::string(body.substr(body.rfind(machine_title))), "a point's machine");
}

double number_at(const nlohmann::ordered_json& json, const char* pointer) {
    return razor::pointed_numbers(json, pointer).front();
}

bool in_closed_form(const Settings& settings) {
    const auto estimate = settings.find("estimate");
    return estimate != settings.end() && plain_text(estimate->second) == "closed-form";
}

/// Where the run itself chooses how it is simulated.
bool chooses_fidelity(const Settings& settings) {
    return settings.contains("fidelity_error");
}

/// What most of them say.
std::string most_said(const std::map<std::string, int>& counts) {
    return std::max_element(counts.begin(), counts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

MachineStudy::MachineStudy(const analysis::Study& study, std::filesystem::path folder, std::string program,
                           const std::atomic<bool>& stop)
    : study_(study), folder_(std::move(folder)), program_(std::move(program)), stop_(stop) {}

std::vector<std::string> MachineStudy::command(const Settings& settings, int seed, const std::string& json,
                                               const std::string& tile_seed) const {
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
        if (key == "scene" || key == "machine") {
            add("--" + key, (folder_ / plain_text(value)).string());
        } else if (key == "estimate") {
            if (plain_text(value) == "none")
                continue;
            if (!chooses_fidelity(settings))
                add("--estimate", plain_text(value));
            if (in_closed_form(settings))
                add("--seed-report", tile_seed);
            else
                add("--estimate-seed", fmt::format("{}", std::max(seed, 1)));
        } else if (key == "fidelity_error") {
            add("--fidelity", "auto");
            add("--error", plain_text(value));
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

std::string MachineStudy::changed(const Point& point) const {
    if (const std::string scene =
            razor::changed_scene(point.settings, folder_, analysis::stated(point.body, "scene_digest"));
        !scene.empty())
        return scene;
    try {
        if (alike(machine_in(point.body), machine_of(point.settings).config))
            return "";
    } catch (const std::exception&) {
        // It cannot be read any more.
    }
    return (folder_ / plain_text(point.settings.at("machine"))).string();
}

MachineDescription MachineStudy::machine_of(const Settings& settings) const {
    std::vector<std::string> overrides;
    const auto machine = settings.find("machine");
    if (machine == settings.end())
        throw razor::UserError("there is no machine; write machine = \"FILE\" under [settings]");
    for (const auto& [key, value] : settings)
        if (find_parameter(key) != nullptr)
            overrides.push_back(fmt::format("{}={}", key, plain_text(value)));
    try {
        return describe_machine((folder_ / plain_text(machine->second)).string(), overrides);
    } catch (const ConfigError& error) {
        // What overrides the machine's file here is the study's.
        std::string what = error.what();
        for (const auto& [key, value] : settings) {
            if (const std::string option = fmt::format("-g {}={}: ", key, plain_text(value));
                what.starts_with(option))
                what.erase(0, option.size());
            const std::string from = key + " from -g";
            if (const std::size_t at = what.find(from); at != std::string::npos)
                what.replace(at, from.size(), fmt::format("{} from {}", key, study_.place_of(key, value)));
        }
        throw ConfigError(what);
    }
}

std::string MachineStudy::own_body(const Settings& settings, int seeds, bool of_tile) const {
    const MachineDescription machine_description = machine_of(settings);
    const Described& scene = described(settings);
    // Marks and comments of the machine's file do not change what is measured.
    std::string config = print_machine(machine_description.config);
    Settings known = analysis::overlaid(scene.settings, settings);
    known.erase("machine");
    known.erase("host_threads"); // changes no digit but the host's
    if (of_tile)
        std::erase_if(known, [](const auto& setting) { return find_parameter(setting.first) != nullptr; });
    const auto threads = settings.find("host_threads");
    return fmt::format("# A point of a study or sweep of razor-sim.\nkind = \"machine\"\nprogram = "
                       "{}\nscene_digest = {}\nseeds = {}\n"
                       "repeats = {}\nhost_threads = {}\n\n[settings]\n{}\n{}{}",
                       toml_text(Value(machine_study_program().name)), toml_text(Value(scene.digest)), seeds,
                       study_.repeats, threads == settings.end() ? "1" : plain_text(threads->second),
                       toml_text(known), machine_title, config);
}

Point MachineStudy::reference_of(const Point& point) const {
    Point out;
    out.settings = analysis::overlaid(point.settings, study_.reference);
    out.settings.erase("fidelity_error"); // a reference is what errors are beside
    out.body = own_body(out.settings, study_.reference_seeds);
    out.name = analysis::point_name(out.body);
    return out;
}

std::string MachineStudy::body(const Point& point) const {
    const auto estimate = point.settings.find("estimate");
    if (chooses_fidelity(point.settings) && estimate != point.settings.end())
        if (const std::string how = plain_text(estimate->second); how != "none" && how != "closed-form")
            throw razor::UserError(fmt::format("fidelity_error chooses samples itself; leave out estimate = "
                                               "\"{}\"",
                                               how));
    std::string out = own_body(point.settings, study_.seeds);
    if (in_closed_form(point.settings))
        out += fmt::format("\n# computed from {}\n", tile_seed_of(point.settings, study_.seeds).name);
    if (!study_.reference.empty())
        try {
            out += fmt::format("\n# compared with {}\n", reference_of(point).name);
        } catch (const std::exception& error) {
            throw razor::UserError(
                study_.placed(fmt::format("its reference, by [reference]: {}", error.what()),
                              analysis::overlaid(point.settings, study_.reference)));
        }
    return out;
}

Point MachineStudy::tile_seed_of(const Settings& settings, int seeds) const {
    const auto known_by = [&](const Settings& point) {
        const Config config = machine_of(point).config;
        const Described& scene = described(point);
        std::string out = scene.digest + toml_text(scene.settings);
        for (const Parameter& p : parameters())
            if (!known_to_seed(p.key) && applies(p, config))
                out += fmt::format("\n{} = {}", p.key, print_value(p, config));
        return out;
    };
    const std::string wanted = known_by(settings);
    const auto keep = [&](const std::string& tile, Settings point) {
        if (tiles_.contains(tile))
            return;
        point.insert_or_assign("chip.tiles", Value(std::int64_t{1}));
        point.erase("workers");
        point.erase("fidelity_error");
        Point out;
        out.body = own_body(point, seeds, true);
        out.name = analysis::point_name(out.body);
        out.settings = std::move(point);
        tiles_.emplace(tile, std::move(out));
    };
    if (tiles_.empty())
        for (const Settings& point : study_.points)
            if (in_closed_form(point))
                try {
                    keep(known_by(point), point);
                } catch (const std::exception&) {
                    // The point is impossible, and says why itself.
                }
    keep(wanted, settings);
    return tiles_.at(wanted);
}

std::vector<Point> MachineStudy::tile_seeds(const std::vector<Point>& points) const {
    std::vector<Point> out;
    std::set<std::string> known;
    for (const Point& point : points)
        if (in_closed_form(point.settings) && point.impossible.empty())
            if (Point one = tile_seed_of(point.settings, study_.seeds); known.insert(one.name).second)
                out.push_back(std::move(one));
    return out;
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

std::string MachineStudy::kept_tile_seed(const Point& tile, int seed, const analysis::Store& store) const {
    const std::filesystem::path folder = store.folder() / "seeds";
    std::filesystem::create_directories(folder);
    const std::string file = (folder / fmt::format("{}-{}.json", tile.name, seed)).string();
    if (!std::filesystem::exists(file)) {
        const razor::ScratchFolder scratch;
        const std::string made = (scratch / "seed.json").string();
        run(command(tile.settings, seed, (scratch / "report.json").string(), made), scratch / "log");
        if (const std::string other = changed(tile); !other.empty())
            throw razor::UserError(fmt::format("{}: was changed while the study ran", other));
        analysis::write_whole(file, razor::read_text_file(made, "a seed"));
    }
    return file;
}

Result MachineStudy::measure_tile_seed(const Point& seed, const analysis::Store& store) const {
    Result out;
    for (int number = 1; number <= study_.seeds; ++number) {
        const std::string file = kept_tile_seed(seed, study_.seeds == 1 ? 0 : number, store);
        out.host["host_processor_seconds"].push_back(
            number_at(razor::read_figures(file, "razor-sim run"), "/host/processor_seconds"));
    }
    return out;
}

Result MachineStudy::run_all(const Settings& settings, int seeds, const analysis::Store& store) const {
    Result out;
    const bool computed = in_closed_form(settings);
    std::map<std::string, int> limiters, ways; // of how many runs
    for (int seed = 1; seed <= seeds; ++seed)
        for (int repeat = 0; repeat < std::max(study_.repeats, 1); ++repeat) {
            const razor::ScratchFolder folder;
            const std::string json = (folder / "report.json").string();
            // One run alone is as the machine's file says; several differ by noise.
            const int noise = seeds == 1 ? 0 : seed;
            run(command(settings, noise, json,
                        computed ? kept_tile_seed(tile_seed_of(settings, seeds), noise, store) : ""),
                folder / "log");
            const nlohmann::ordered_json report = razor::read_figures(json, "razor-sim run");
            out.host["host_seconds"].push_back(number_at(report, "/host/seconds"));
            // With all that was tried, where the run chose.
            out.host["host_processor_seconds"].push_back(
                number_at(report, chooses_fidelity(settings) ? "/host/fidelity/processor_seconds"
                                                             : "/host/processor_seconds"));
            out.host["instructions_per_second"].push_back(number_at(report, "/host/instructions_per_second"));
            if (report["host"].contains("seed_processor_seconds"))
                out.host["seed_processor_seconds"].push_back(
                    number_at(report, "/host/seed_processor_seconds"));
            if (repeat == 0) {
                add_figures(out.values, report);
                ++limiters[limiter_name(report)];
                if (chooses_fidelity(settings))
                    ++ways[report.at("fidelity").at("chosen").get<std::string>()];
            }
        }
    out.details = nlohmann::ordered_json::object();
    out.details["limited_by"] = most_said(limiters);
    if (!ways.empty())
        out.details["fidelity"] = most_said(ways);
    return out;
}

Result MachineStudy::measure_reference(const Point& reference, const analysis::Store& store) const {
    return run_all(reference.settings, study_.reference_seeds, store);
}

Result MachineStudy::measure(const Point& point, const analysis::Store& store) const {
    Result out = run_all(point.settings, study_.seeds, store);
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
