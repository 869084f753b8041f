#include "sim/reports/compare.h"

#include "sim/config/error.h"
#include "sim/reports/flat.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

namespace sim {
namespace {

using nlohmann::json;

/// What a run is judged by, in this order; stacks and what is not there follow the machine.
constexpr std::array judged{"cycles",
                            "seconds",
                            "core.instructions",
                            "core.vops",
                            "core.loads",
                            "core.stores",
                            "core.mispredicts",
                            "l1.misses",
                            "l1.write_backs",
                            "l2.misses",
                            "l2.write_backs",
                            "l3.misses",
                            "l3.write_backs",
                            "l4.misses",
                            "l4.write_backs",
                            "l5.misses",
                            "l5.write_backs",
                            "tlb.misses",
                            "network.messages",
                            "network.bytes",
                            "memory.reads",
                            "memory.writes",
                            "memory.row_hits",
                            "memory.activates",
                            "bandwidth.L1.utilisation",
                            "bandwidth.L2.utilisation",
                            "bandwidth.L3.utilisation",
                            "bandwidth.L4.utilisation",
                            "bandwidth.L5.utilisation",
                            "bandwidth.memory.utilisation",
                            "energy.joules",
                            "energy.watts",
                            "energy.joule_seconds"};

/// Parts of reports that are no results of the machine's.
const std::set<std::string>& not_figures() {
    static const std::set<std::string> keys{"program", "version", "options", "scene",
                                            "machine", "host",    "jitter",  "machine_provenance"};
    return keys;
}

json results_of(const json& report) {
    json results = json::object();
    for (const auto& item : report.items())
        if (!not_figures().contains(item.key()) && item.key() != "traffic" && item.key() != "touched_lines")
            results[item.key()] = item.value();
    return results;
}

/// All that says which design it is, but for jitter's seed.
std::map<std::string, std::string> settings_of(const json& report) {
    std::map<std::string, std::string> all = flat_words(report.value("machine", json::object()));
    all.merge(flat_words(report.value("options", json::object()), "run"));
    all["run.mode"] = report.value("mode", std::string());
    const json estimate = report.value("estimate", json::object()); // else all was simulated
    if (const auto how = estimate.find("how"); how != estimate.end() && how->is_string())
        all["run.estimate"] = how->get<std::string>();
    all.erase("sim.jitter");
    return all;
}

std::map<std::string, std::string> lines_of(const std::string& text) {
    std::map<std::string, std::string> lines;
    std::istringstream in(text);
    std::string line;
    for (int n = 1; std::getline(in, line); ++n)
        lines[fmt::format("{:6}", n)] = line;
    return lines;
}

std::vector<SettingChange> changes(const std::map<std::string, std::string>& first,
                                   const std::map<std::string, std::string>& second) {
    std::vector<SettingChange> all;
    for (const auto& [name, value] : first) {
        const auto other = second.find(name);
        if (other == second.end())
            all.push_back({name, value, ""});
        else if (other->second != value)
            all.push_back({name, value, other->second});
    }
    for (const auto& [name, value] : second)
        if (!first.contains(name))
            all.push_back({name, "", value});
    std::sort(all.begin(), all.end(),
              [](const SettingChange& a, const SettingChange& b) { return a.name < b.name; });
    return all;
}

using Pointer = json::json_pointer;

/// Of memory: the last cache's.
double line_bytes_of(const json& report) {
    double bytes = 64;
    for (int level = 1;; ++level) {
        const Pointer cache(fmt::format("/machine/l{}", level));
        if (!report.contains(cache))
            return bytes;
        if (level == 1 || report.at(cache).value("size_bytes", 0.0) > 0)
            bytes = report.at(cache).value("line_bytes", bytes);
    }
}

std::map<std::string, double> memory_bytes_of(const json& report) {
    std::map<std::string, double> bytes;
    const json traffic = report.value("traffic", json::array());
    const double line = line_bytes_of(report);
    for (const json& row : traffic)
        bytes[row.value("structure", std::string("unknown"))] +=
            line * (row.value("memory_reads", 0.0) + row.value("memory_writes", 0.0));
    return bytes;
}

FigureRange range_of(const std::vector<std::map<std::string, double>>& reports, const std::string& name) {
    std::vector<double> values;
    for (const std::map<std::string, double>& r : reports)
        if (const auto found = r.find(name); found != r.end())
            values.push_back(found->second);
    if (values.empty())
        return {.known = false};
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

using Flat = std::vector<std::map<std::string, double>>;

void check_one_design(std::span<const ReportFile> reports) {
    for (const ReportFile& r : reports) {
        const std::vector<SettingChange> other =
            changes(settings_of(reports.front().json), settings_of(r.json));
        if (!other.empty())
            throw ConfigError(fmt::format(
                "{}: of another design than {}: {} is {}, not {}; give reports of one design together",
                r.file, reports.front().file, other.front().name, other.front().second, other.front().first));
        if (r.json.value("scene", std::string()) != reports.front().json.value("scene", std::string()))
            throw ConfigError(fmt::format("{}: of another scene than {}; give reports of one design together",
                                          r.file, reports.front().file));
    }
}

/// What is read of a report has the type it is read by, where it is there: the first part that has not, or
/// none.
std::string misfit(const json& report) {
    const auto wrong = [&report](const Pointer& at, bool (*fits)(const json&)) {
        return report.contains(at) && !fits(report.at(at));
    };
    constexpr auto object = [](const json& j) { return j.is_object(); };
    constexpr auto text = [](const json& j) { return j.is_string(); };
    constexpr auto number = [](const json& j) { return j.is_number(); };
    for (const char* part : {"/machine", "/options", "/stack", "/estimate"})
        if (wrong(Pointer(part), object))
            return part;
    for (const char* part : {"/scene", "/mode"})
        if (wrong(Pointer(part), text))
            return part;
    for (int level = 1; report.contains(Pointer(fmt::format("/machine/l{}", level))); ++level) {
        const std::string cache = fmt::format("/machine/l{}", level);
        if (wrong(Pointer(cache), object))
            return cache;
        for (const char* const key : {"/size_bytes", "/line_bytes"})
            if (wrong(Pointer(cache + key), number))
                return cache + key;
    }
    if (!report.contains("traffic"))
        return {};
    if (!report.at("traffic").is_array())
        return "/traffic";
    for (std::size_t row = 0; row < report.at("traffic").size(); ++row) {
        const std::string at = fmt::format("/traffic/{}", row);
        if (wrong(Pointer(at), object) || wrong(Pointer(at + "/structure"), text) ||
            wrong(Pointer(at + "/memory_reads"), number) || wrong(Pointer(at + "/memory_writes"), number))
            return at;
    }
    return {};
}

} // namespace

double FigureChange::ratio() const {
    return first.median == 0 || !known() ? std::numeric_limits<double>::quiet_NaN()
                                         : second.median / first.median;
}

bool FigureChange::beyond_spread() const {
    return known() && first.median != second.median &&
           (first.most < second.least || second.most < first.least);
}

ReportFile read_report(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw ConfigError(fmt::format("{}: is a folder; give a report of razor-sim run --json", file));
    std::ifstream in(file);
    if (!in)
        throw ConfigError(fmt::format("{}: cannot be read; give a report of razor-sim run --json", file));
    const auto nests = [&file](int depth, json::parse_event_t, json&) {
        if (depth > 64)
            throw ConfigError(fmt::format("{}: nests more than 64 deep, which no report does; write one with "
                                          "razor-sim run --json {}",
                                          file, file));
        return true;
    };
    ReportFile r{file, json::parse(in, nests, false)};
    if (r.json.is_discarded() || !r.json.is_object() || r.json.value("program", json()) != "razor-sim" ||
        !r.json.contains("cycles") || !r.json.contains("machine"))
        throw ConfigError(fmt::format(
            "{}: no report of a simulated run; write one with razor-sim run --json {}", file, file));
    if (const std::string part = misfit(r.json); !part.empty())
        throw ConfigError(
            fmt::format("{}: its {} is not what razor-sim writes there; write the report anew with "
                        "razor-sim run --json {}",
                        file, part, file));
    return r;
}

ReportComparison compare_reports(std::span<const ReportFile> first, std::span<const ReportFile> second) {
    check_one_design(first);
    check_one_design(second);
    ReportComparison c;
    c.several = first.size() > 1 || second.size() > 1;
    const json &a = first.front().json, &b = second.front().json;
    c.settings = changes(settings_of(a), settings_of(b));
    c.scene = changes(lines_of(a.value("scene", std::string())), lines_of(b.value("scene", std::string())));

    const auto flat_of = [](std::span<const ReportFile> reports, const auto& flatten) {
        Flat all;
        for (const ReportFile& r : reports)
            all.push_back(flatten(r.json));
        return all;
    };
    const auto numbers = [](const json& report) { return flat_numbers(results_of(report)); };
    const Flat of_first = flat_of(first, numbers), of_second = flat_of(second, numbers);
    const auto change_of = [](const std::string& name, const Flat& one, const Flat& other) {
        return FigureChange{name, range_of(one, name), range_of(other, name)};
    };
    const auto is_there = [](const FigureChange& f) { return f.first.most != 0 || f.second.most != 0; };
    const auto names_in = [](const Flat& one, const Flat& other) {
        std::set<std::string> names;
        for (const Flat* flat : {&one, &other})
            for (const std::map<std::string, double>& r : *flat)
                for (const auto& figure : r)
                    names.insert(figure.first);
        return names;
    };
    std::vector<std::string> order(judged.begin(), judged.end());
    const json stack = a.value("stack", json::object());
    for (const auto& part : stack.items())
        order.push_back("stack." + part.key());
    for (const std::string& name : order)
        if (const FigureChange f = change_of(name, of_first, of_second); is_there(f))
            c.figures.push_back(f);
    Flat bytes_of_first = flat_of(first, memory_bytes_of), bytes_of_second = flat_of(second, memory_bytes_of);
    const std::set<std::string> structures = names_in(bytes_of_first, bytes_of_second);
    for (const auto& [reports, bytes] : {std::pair{first, &bytes_of_first}, {second, &bytes_of_second}})
        for (std::size_t k = 0; k < reports.size(); ++k)
            if (reports[k].json.contains("traffic")) // of what it does not name there was none
                for (const std::string& name : structures)
                    (*bytes)[k].try_emplace(name, 0.0);
    for (const std::string& name : structures)
        if (const FigureChange f = change_of(name, bytes_of_first, bytes_of_second); is_there(f))
            c.memory_bytes.push_back(f);
    for (const std::string& name : names_in(of_first, of_second))
        if (const FigureChange f = change_of(name, of_first, of_second);
            (f.first.median != f.second.median || !f.known()) &&
            std::find(order.begin(), order.end(), name) == order.end())
            c.all.push_back(f);
    return c;
}

} // namespace sim
