#include "sim/replay/replay_report.h"

#include "sim/machine/json_parts.h"
#include "traces/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <map>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

/// Whether a column is of memory, or of a level that the replay drove.
bool is_driven(const TrafficColumn& column, const Report& r, unsigned first_level) {
    if (column.level >= r.config.cache_levels())
        return false;
    for (unsigned level = 0; level < first_level; ++level) {
        const TrafficOfLevel& of = traffic_of_level[level];
        if (column.count == of.reads || column.count == of.writes || column.count == of.misses ||
            column.count == of.write_backs)
            return false;
    }
    return true;
}

/// Levels of what lies there are in no trace: rows are of all of them.
json traffic(const Report& r, unsigned first_level) {
    json out = json::array();
    for (const TrafficRow& t : r.traffic) {
        json row = {{"structure", r.structures[t.structure]},
                    {"kind", r.labels.kinds[r.labels.kind(t.column)]},
                    {"phase", r.labels.phases[r.labels.phase(t.column)]}};
        for (const TrafficColumn& column : traffic_columns)
            if (is_driven(column, r, first_level))
                row[column.name] = t.traffic.*column.count;
        out.push_back(std::move(row));
    }
    return out;
}

/// What a replay and a run count alike.
json counts(const ReplayResult& result) {
    const Report& r = result.report;
    const unsigned first_level = result.first_level;
    json out = json::object();
    for (unsigned level = first_level; level < r.config.cache_levels(); ++level) {
        const std::string name = fmt::format("l{}", level + 1);
        out[name] = json_of_counters(r.cache_total(level), cache_counters);
        const char* by = level == 0                                                       ? "core"
                         : level == 1 && r.config.cores_sharing(1) == r.config.chip.cores ? "tile"
                                                                                          : "cache";
        for (const CacheCounters& c : r.caches(level))
            out[fmt::format("{}_by_{}", name, by)].push_back(json_of_counters(c, cache_counters));
    }
    // The L1s' ports are busy with what the cores make of their accesses.
    if (first_level == 0) {
        out["l1"].erase("busy_cycles");
        for (json& c : out["l1_by_core"])
            c.erase("busy_cycles");
    }
    if (r.config.coherence.kept() && !result.memory_alone)
        out["coherence"] = json_of_counters(r.coherence, coherence_counters);
    if (!r.network.ideal() && !result.memory_alone)
        out["network"] = json_of_counters(r.network.counters, network_counters);
    out["memory"] = json_of_counters(r.memory, memory_counters);
    for (const MemoryCounters& c : r.memory_by_rank)
        out["memory_by_rank"].push_back(json_of_counters(c, memory_counters));
    return out;
}

void compare(const std::string& part, const json& replayed, const json& run, std::vector<Comparison>& out) {
    if (replayed.is_array()) {
        for (std::size_t i = 0; i < replayed.size(); ++i)
            compare(fmt::format("{}[{}]", part, i), replayed.at(i), run.at(i), out);
        return;
    }
    for (const auto& [name, value] : replayed.items())
        out.push_back({part, name, value.get<std::uint64_t>(), run.at(name).get<std::uint64_t>()});
}

/// Rows of a run, levels of what lies there together, beside those of the replay.
void compare_traffic(const Report& r, unsigned first_level, const json& run, std::vector<Comparison>& out) {
    std::map<std::string, std::map<std::string, Comparison>> rows;
    const auto add = [&](const json& row, std::uint64_t Comparison::*side) {
        const std::string part =
            fmt::format("traffic of {}, {}, {}", row.at("structure").get<std::string>(),
                        row.at("kind").get<std::string>(), row.at("phase").get<std::string>());
        for (const TrafficColumn& column : traffic_columns)
            if (is_driven(column, r, first_level)) {
                Comparison& c = rows[part][column.name];
                c.part = part;
                c.counter = column.name;
                c.*side += row.at(column.name).get<std::uint64_t>();
            }
    };
    for (const json& row : traffic(r, first_level))
        add(row, &Comparison::replayed);
    for (const json& row : run)
        add(row, &Comparison::run);
    for (const auto& [part, columns] : rows)
        for (const auto& [name, c] : columns)
            out.push_back(c);
}

} // namespace

std::string print_replay(const ReplayResult& result) {
    const Report& r = result.report;
    json out = {{"machine", json_of_configuration(r.config)},
                {"cycles", r.cycles},
                {"window_cycles", r.window},
                {"replay",
                 {{"references", result.references},
                  {"waits", result.waits},
                  {"delay_cycles", result.delay},
                  {"timed", result.timed},
                  {"windows_of_the_run", result.windows},
                  {"ended", result.ended},
                  {"first_level", result.first_level + 1},
                  {"memory_alone", result.memory_alone}}}};
    json left_out = json::object();
    for (std::size_t k = 0; k < result.left_out.size(); ++k)
        if (result.left_out[k] != 0)
            left_out[traces::kind_names[k]] = result.left_out[k];
    out["replay"]["left_out"] = std::move(left_out);
    out.update(counts(result));
    out["traffic"] = traffic(r, result.first_level);
    return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

double Comparison::error() const {
    if (replayed == run)
        return 0;
    if (run == 0)
        return std::numeric_limits<double>::infinity();
    return std::abs(static_cast<double>(replayed) - static_cast<double>(run)) / static_cast<double>(run);
}

std::vector<Comparison> compare_with_run(const ReplayResult& result, const std::string& report,
                                         const std::string& name) {
    std::vector<Comparison> out;
    try {
        const json run = json::parse(report);
        if (!run.is_object() || !run.contains("warm_up_cycles"))
            throw traces::Error(
                fmt::format("{}: is no report of a run; give what razor-sim run --json wrote", name));
        const json counted = counts(result);
        for (const auto& [part, values] : counted.items()) {
            if (!run.contains(part) || (values.is_array() && run.at(part).size() != values.size()))
                throw traces::Error(
                    fmt::format("{}: is of a machine without the same {}; compare runs of the "
                                "machine that the trace is replayed on",
                                name, part));
            compare(part, values, run.at(part), out);
        }
        compare_traffic(result.report, result.first_level, run.at("traffic"), out);
    } catch (const json::exception& e) {
        throw traces::Error(fmt::format(
            "{}: is no report of a run ({}); give what razor-sim run --json wrote", name, e.what()));
    }
    return out;
}

} // namespace sim
