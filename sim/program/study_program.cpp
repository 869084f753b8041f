#include "sim/program/study_program.h"

#include "analysis/study/error.h"
#include "razor/program/arguments.h"
#include "razor/program/study/command.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "sim/program/estimates.h"
#include "sim/program/report_figures.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>
#include <utility>

namespace sim {
namespace {

using analysis::plain_text;
using analysis::Settings;
using analysis::Value;

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

/// Of a key as machines' files have them.
std::string no_machine_setting(std::string_view key) {
    std::vector<std::string_view> known;
    for (const Parameter& p : parameters())
        known.push_back(p.key);
    const std::string_view near = razor::meant(key, known);
    const std::string what = fmt::format("unknown setting {}; ", razor::printable(key));
    return what + (near.empty() ? "razor-sim print-config says which machines have"
                                : fmt::format("did you mean {}?", near));
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
    if (key == "fidelity_error")
        return razor::wrong_number(key, value, 0, 1);
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
        return no_machine_setting(key);
    return razor::no_scene_setting(key, run_keys());
}

/// Of a setting that a study's point leaves to its machine's file.
double machine_number(const Settings& point, std::string_view key, const std::string& study) {
    const Parameter* const p = find_parameter(key);
    if (p == nullptr && key.find('.') != std::string_view::npos)
        throw analysis::StudyError(no_machine_setting(key));
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

} // namespace

const std::vector<std::string_view>& run_keys() {
    static const std::vector<std::string_view> keys{"machine", "workers",  "host_threads",
                                                    "frames",  "tiles",    "memory",
                                                    "seed",    "estimate", "fidelity_error"};
    return keys;
}

razor::StudyProgram machine_study_program() {
    razor::StudyProgram out;
    out.name = fmt::format("razor-sim {}", razor::version());
    out.figures = {{"host_seconds", "host, s"},
                   {"host_processor_seconds", "host, processor seconds"},
                   {"instructions_per_second", "simulated instructions a second of the host", true},
                   {"seed_processor_seconds", "host, processor seconds of the tile's seed, made before"},
                   {"cycles_error", "error of cycles, relative"},
                   {"cycles_deviation", "cycles beside the reference's, with its sign"},
                   {"dram_bytes_error", "error of bytes from and to DRAM, relative"},
                   {"l1_miss_rate_error", "error of the L1s' miss rate, absolute"},
                   {"l2_miss_rate_error", "error of the L2s' miss rate, absolute"}};
    out.figures.insert(out.figures.end(), report_figures().begin(), report_figures().end());
    for (const analysis::Figure& figure : out.figures)
        if (figure.name.ends_with("_error") || figure.name.ends_with("_deviation"))
            out.vocabulary.of_references.push_back(figure.name);
    out.vocabulary.kind = "machine";
    out.vocabulary.files = {"machine", "scene"};
    out.vocabulary.wrong = wrong_setting;
    out.vocabulary.preset = machine_number;
    out.name_figures();
    out.views.plots = {{"host_processor_seconds", "cycles_error", {}}};
    out.views.words = {"fidelity"};
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
    out.figures.push_back(
        {"seed_processor_seconds", "host, processor seconds of the tile's seed, made before"});
    out.vocabulary.kind = "sweep";
    out.vocabulary.files = {"machine", "scene"};
    out.vocabulary.wrong = wrong_setting;
    out.vocabulary.preset = machine_number;
    out.name_figures();
    out.views = {{{"seconds", "energy_joules", {}}},
                 {"cycles", "dram_bytes", "energy_joules"},
                 true,
                 {"limited_by", "fidelity"}};
    out.remarks = {
        "Runs of a design differ in sim.jitter alone (seeds 1 to N): designs whose runs overlap are not told "
        "apart."};
    return out;
}

} // namespace sim
