// Two designs by the reports of their runs: what differs in machine and scene, and what became of the
// figures. Several reports of a design, that differ in jitter alone, say how much of a difference means
// nothing.
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace sim {

struct ReportFile {
    std::string file;
    nlohmann::json json;
};

/// Reads a report of `razor-sim run`. Throws ConfigError where the file is none.
ReportFile read_report(const std::string& file);

/// Of one figure in all reports of a design.
struct FigureRange {
    double median = 0, least = 0, most = 0;
    bool known = true; // else none of the reports has it
};

struct FigureChange {
    std::string name; // as in reports, "l2.misses"; see `razor-sim explain`
    FigureRange first, second;

    /// Whether both designs have it.
    bool known() const { return first.known && second.known; }
    /// Second over first by their medians; not a number where the first is 0, or one of them is unknown.
    double ratio() const;
    /// Whether both are known, their ranges do not meet, and the medians differ at all.
    bool beyond_spread() const;
};

struct SettingChange {
    std::string name, first, second; // empty: not there
};

struct ReportComparison {
    std::vector<SettingChange> settings;    // of machine and run
    std::vector<SettingChange> scene;       // lines of its file, by number
    std::vector<FigureChange> figures;      // what a run is judged by, those that are not 0 in both
    std::vector<FigureChange> memory_bytes; // by data structure, to and from memory
    std::vector<FigureChange> all;          // every other number but the host's, where the two differ
    bool several = false;                   // reports of a design: ranges mean something
};

/// Throws ConfigError where the reports of one design are not of the same one.
ReportComparison compare_reports(std::span<const ReportFile> first, std::span<const ReportFile> second);

/// For people. `noise`: differences of less than so many percent are said to mean nothing. `everything`: with
/// all that differs by as much or more.
std::string comparison_text(const ReportComparison& comparison, double noise, bool everything);
std::string comparison_json(const ReportComparison& comparison);

} // namespace sim
