#include "sim/program/report_figures.h"

#include <fmt/format.h>

#include <cctype>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

/// Figures that a report holds as they are, by JSON pointers.
struct Pointed {
    const char *name, *over;
};
constexpr Pointed pointed[] = {{"cycles", "/cycles"},
                               {"seconds", "/seconds"},
                               {"instructions", "/core/instructions"},
                               {"dram_reads", "/memory/reads"},
                               {"dram_writes", "/memory/writes"},
                               {"row_hits", "/memory/row_hits"},
                               {"l1_misses", "/l1/misses"},
                               {"l2_misses", "/l2/misses"},
                               {"l3_misses", "/l3/misses"},
                               {"l4_misses", "/l4/misses"},
                               {"l5_misses", "/l5/misses"},
                               {"energy_joules", "/energy/joules"},
                               {"watts", "/energy/watts"}};

double number_at(const json& report, const std::string& pointer) {
    return report.at(json::json_pointer(pointer)).get<double>();
}

bool has(const json& report, const std::string& pointer) {
    return report.contains(json::json_pointer(pointer));
}

double rate(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

/// Of the last level of caches, whose lines are the memory's.
double memory_line_bytes(const json& report) {
    double out = 0;
    for (const auto& [name, level] : report.at("machine").items())
        if (name.size() == 2 && name[0] == 'l' && level.contains("line_bytes") &&
            level.value("size_bytes", 0.0) > 0)
            out = level.at("line_bytes").get<double>();
    return out;
}

std::string lower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

} // namespace

const std::vector<analysis::Figure>& report_figures() {
    static const std::vector<analysis::Figure> all{
        {"cycles", "cycles"},
        {"seconds", "simulated time, s"},
        {"rays_per_second", "rays a second of simulated time", true},
        {"instructions", "instructions"},
        {"ipc", "instructions a cycle of the chip", true},
        {"dram_bytes", "bytes from and to DRAM"},
        {"dram_reads", "lines read from DRAM"},
        {"dram_writes", "lines written to DRAM"},
        {"row_hits", "row hits"},
        {"l1_misses", "misses of L1s"},
        {"l1_miss_rate", "misses of L1s, of all accesses"},
        {"l2_misses", "misses of L2s"},
        {"l2_miss_rate", "misses of L2s, of all accesses"},
        {"l3_misses", "misses of the third level"},
        {"l3_miss_rate", "misses of the third level, of all accesses"},
        {"l4_misses", "misses of the fourth level"},
        {"l4_miss_rate", "misses of the fourth level, of all accesses"},
        {"l5_misses", "misses of the fifth level"},
        {"l5_miss_rate", "misses of the fifth level, of all accesses"},
        {"l1_utilisation", "bandwidth of L1s, of the peak"},
        {"l2_utilisation", "bandwidth of L2s, of the peak"},
        {"l3_utilisation", "bandwidth of the third level, of the peak"},
        {"l4_utilisation", "bandwidth of the fourth level, of the peak"},
        {"l5_utilisation", "bandwidth of the fifth level, of the peak"},
        {"memory_utilisation", "bandwidth of DRAM, of the peak"},
        {"binding_share", "time for which the busiest resource works, of the run"},
        {"energy_joules", "energy, J"},
        {"watts", "power, W"},
        {"built_megabytes", "grids, kd nodes and item lists built, MB"}};
    return all;
}

void add_figures(analysis::Samples& values, const json& report) {
    for (const Pointed& figure : pointed)
        if (has(report, figure.over))
            values[figure.name].push_back(number_at(report, figure.over));
    const double cycles = number_at(report, "/cycles");
    values["ipc"].push_back(rate(number_at(report, "/core/instructions"), cycles));
    values["rays_per_second"].push_back(
        rate(number_at(report, "/renderer/counters/rays"), number_at(report, "/seconds")));
    values["dram_bytes"].push_back(memory_line_bytes(report) * (number_at(report, "/memory/reads") +
                                                                number_at(report, "/memory/writes")));
    for (const char* level : {"l1", "l2", "l3", "l4", "l5"}) {
        const std::string at = fmt::format("/{}/", level);
        if (has(report, at + "misses"))
            values[fmt::format("{}_miss_rate", level)].push_back(
                rate(number_at(report, at + "misses"),
                     number_at(report, at + "reads") + number_at(report, at + "writes")));
    }
    // An estimate says nothing of what was busy.
    const json bandwidth = report.value("bandwidth", json::object());
    for (const auto& [level, band] : bandwidth.items())
        values[lower(level) + "_utilisation"].push_back(band.at("utilisation").get<double>());
    const json limits = report.value("limits", json::array());
    for (const json& limit : limits)
        if (limit.at("resource") == report.at("binding"))
            values["binding_share"].push_back(limit.at("share").get<double>());
    double built = 0;
    for (const char* part : {"grid_bytes", "node_bytes", "list_bytes"})
        built += report.at("renderer").at("built").at(part).get<double>();
    values["built_megabytes"].push_back(built * 1e-6);
}

std::string limiter_name(const json& report) {
    // "issue slots: busy for 88 % of the run", or "waiting (memory, 40 % of ...".
    if (report.contains("estimate"))
        return "not known of an estimate";
    const auto text = report.at("limiter").get<std::string>();
    const std::string first = text.substr(0, text.find_first_of(":,"));
    constexpr std::string_view waiting = "waiting (";
    return first.starts_with(waiting) ? "waiting: " + first.substr(waiting.size()) : first;
}

} // namespace sim
