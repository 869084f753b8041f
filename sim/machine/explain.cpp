#include "sim/machine/explain.h"

#include "sim/config/parameters.h"
#include "sim/machine/report.h"

#include <fmt/core.h>

#include <algorithm>

namespace sim {
namespace {

using Explanations = std::vector<Explanation>;

template <class Rows> void add_counters(Explanations& out, const std::string& object, const Rows& rows) {
    for (const auto& row : rows)
        out.push_back({fmt::format("{}.{}", object, row.name), "", row.meaning});
}

void add_stack(Explanations& out, const std::string& object, const char* whose) {
    for (const CauseName& c : causes)
        out.push_back(
            {fmt::format("{}.{}", object, c.name), "cycles", fmt::format("{}: {}", whose, c.meaning)});
}

/// A sum and the same by part.
template <class Rows>
void add_level(Explanations& out, const std::string& level, const std::string& parts, const Rows& rows) {
    add_counters(out, level, rows);
    add_counters(out, parts + "[]", rows);
}

/// Of the JSON report, then of the file.
void add_intervals(Explanations& out) {
    out.push_back({"intervals.cycles", "cycles", "of an interval (--interval); absent where none were kept"});
    out.push_back({"intervals.rows", "", "intervals of the file (--intervals); the last is after the run"});
    const std::string file = "intervals[].";
    out.push_back({file + "interval", "", "a row of the file: its number"});
    out.push_back({file + "begin", "cycles", "its first"});
    out.push_back({file + "end", "cycles",
                   "the next one's first; the last row goes from the workers' end until memory was quiet"});
    for (const auto& c : interval_counters)
        out.push_back({file + c.name, "", fmt::format("{}, in the interval", c.meaning)});
    out.push_back({file + "ipc", "", "machine instructions a cycle and core in the interval"});
    out.push_back({file + "memory_bytes", "bytes", "to and from memory in the interval"});
    for (const CauseName& c : causes)
        out.push_back({fmt::format("{}stack_{}", file, c.name), "cycles",
                       fmt::format("all threads, in the interval: {}", c.meaning)});
}

/// Absent where costs were not shared among owners.
void add_owners(Explanations& out) {
    for (const OwnerFigure& f : owner_figures(most_levels)) {
        const std::string path = "owners." + f.name,
                          unit = f.of_traffic != nullptr || f.name == "instructions" ? "" : "cycles";
        out.push_back(
            {path + ".owners", unit,
             fmt::format("{}, of all owners of lanes together (pixels); absent without --costs", f.meaning)});
        out.push_back({path + ".builds", unit, fmt::format("of these, in phases that build: {}", f.meaning)});
        out.push_back({path + ".nobody", unit, fmt::format("{}, which no lane's owner caused", f.meaning)});
    }
}

Explanations make() {
    Explanations out;
    for (const Parameter& p : parameters())
        out.push_back({"machine." + p.key, p.unit, p.meaning});
    const auto add = [&out](const char* path, const char* unit, const char* meaning) {
        out.push_back({path, unit, meaning});
    };
    add("mode", "", "of the simulation, that made all that follows: fast or reference (sim.mode)");
    add("workers", "", "workers, each on a hardware thread of its own");
    add("warm_up_cycles", "cycles", "before what counts: all other figures but the host's are from then on");
    add("cycles", "cycles", "until the last worker had returned and its last result was there");
    add("drained_cycles", "cycles", "until memory was quiet as well");
    add("window_cycles", "cycles", "in which tiles run by themselves");
    add("seconds", "s", "simulated time: cycles times chip.clock_ps");
    add("jitter.seed", "", "of the noise; 0: there was none");
    add("jitter.lines", "", "lines that L1s asked for, each 0 or 1 cycle later by chance");
    add("jitter.cycles", "cycles", "that this added, all lines together");
    add_intervals(out);
    add("coherence_of_plain_data", "", "whether stores to words that are not shared invalidate other copies");
    add_counters(out, "core", core_counters);
    add("instructions_by_class.*.scalar", "",
        "machine instructions on one value; looks of waiting threads are of no class");
    add("instructions_by_class.*.vector", "", "machine instructions on core.lanes values");
    add_stack(out, "stack", "all threads");
    add("cores[].core", "", "number through all tiles");
    add("cores[].instructions", "", "machine instructions of its threads");
    add_stack(out, "cores[].stack", "the core's threads");
    add("cores[].port_instructions[]", "", "what each port of core.pairing took; absent where any takes all");
    add("shared_unit_cycles[]", "cycles",
        "taken of each unit of core.shared_classes; absent where none is shared");
    add("phases[].phase", "", "of the frame");
    add("phases[].vops", "", "vocabulary operations in it");
    add("phases[].instructions", "", "machine instructions in it");
    add("kinds[].kind", "", "of work: none, or the kind of ray that asked for it");
    add("kinds[].vops", "", "vocabulary operations for it");
    add("kinds[].instructions", "", "machine instructions for it");
    add_stack(out, "kinds[].stack", "all threads, for it");
    add_level(out, "l1", "l1_by_core", cache_counters);
    add_level(out, "l2", "l2_by_tile", cache_counters);
    add_counters(out, "l2_by_cache[]", cache_counters); // where a tile has several
    for (unsigned level = 2; level < most_levels; ++level)
        add_level(out, fmt::format("l{}", level + 1), fmt::format("l{}_by_cache", level + 1), cache_counters);
    add_level(out, "tlb", "tlb_by_core", tlb_counters); // absent where there is none
    add_counters(out, "coherence", coherence_counters); // absent where plain data are not kept coherent
    add_counters(out, "network", network_counters);     // all of it absent where the network is ideal
    add("network.busiest_link", "",
        "the link that moved most: of a unit, from it or to it, or between routers");
    add("network.busiest_utilisation", "", "of the drained cycles, those in which that link moved a flit");
    add("network.mean_utilisation", "", "the same of all links together");
    add("network.links[].link", "", "its name");
    add("network.links[].flits", "", "that it moved, one a cycle at most");
    add_level(out, "memory", "memory_by_rank", memory_counters);
    add("memory.last_clock", "memory clocks", "in which the last burst ended");
    add("bandwidth.*.achieved_gb_s", "GB/s", "moved by all of the level's parts, over the run");
    add("bandwidth.*.peak_gb_s", "GB/s", "what they can move at most");
    add("bandwidth.*.utilisation", "", "achieved over peak");
    add("limits[].resource", "", "of which the busiest instance alone bounds the run from below");
    add("limits[].cycles", "cycles", "that it takes at the least for this work: no run is shorter");
    add("limits[].share", "", "of the drained cycles");
    add("binding", "", "the resource with the largest bound");
    add("limiter", "", "what bounds the run, or what it waits for if no resource is busy for most of it");
    add("energy.joules", "J",
        "of the run until memory was quiet, by machine.energy and machine.memory; 0: none is stated");
    add("energy.watts", "W", "of it, on average");
    add("energy.joule_seconds", "J s", "energy times the time until memory was quiet");
    add("energy.parts[].part", "", "of the machine");
    add("energy.parts[].events", "", "that took energy; of parts at rest: cycles");
    add("energy.parts[].joules", "J", "that it took");
    add("traffic[].structure", "", "of data, as its arena is named; spill: registers");
    add("traffic[].level", "", "of detail of what lies there; null where none is known");
    add("traffic[].kind", "", "of work that caused it");
    add("traffic[].phase", "", "that caused it");
    add_counters(out, "traffic[]", traffic_columns);
    add("touched_lines[].structure", "", "of data");
    add("touched_lines[].lines", "", "different lines accessed by just these kinds and phases");
    add("touched_lines[].by.*[]", "", "a kind's phases that accessed them");
    add_owners(out);
    add("threads[].tile", "", "its tile");
    add("threads[].core", "", "its core, numbered through all tiles");
    add("threads[].thread", "", "its number in the core");
    add("threads[].worker", "", "that ran on it; -1: none");
    add("threads[].finish", "cycles", "when its last result was there");
    add("threads[].instructions", "", "machine instructions");
    add_stack(out, "threads[].stack_of_all_phases", "the thread");
    add_stack(out, "threads[].stack.*", "the thread, in a phase");
    add("host.seconds", "s", "of the host, for the simulation");
    add("host.processor_seconds", "s", "that the host's processor worked, all threads together");
    add("host.threads", "", "of the host that tiles ran on");
    add("host.vops_per_second", "1/s", "vocabulary operations a second of processor time");
    add("host.instructions_per_second", "1/s", "machine instructions a second of processor time");
    return out;
}

/// The part of a path up to the next dot, cut off.
std::string_view cut_name(std::string_view& path) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const std::string_view name = path.substr(0, dot);
    path.remove_prefix(std::min(dot + 1, path.size()));
    return name;
}

/// Without the marks of arrays.
std::string plain(std::string_view path) {
    std::string out(path);
    for (std::size_t at = out.find("[]"); at != std::string::npos; at = out.find("[]"))
        out.erase(at, 2);
    return out;
}

/// Whether the path begins with the words. An element of an array has any names of its own, or a number.
bool names_within(std::string_view path, std::string_view words, bool literal) {
    if (words.empty())
        return literal;
    if (path.empty())
        return false;
    std::string_view name = cut_name(path);
    const bool array = name.ends_with("[]");
    if (array)
        name.remove_suffix(2);
    const std::string_view word = cut_name(words);
    if (name != "*" && name != word)
        return false;
    literal = literal || name == word;
    if (names_within(path, words, literal))
        return true;
    while (array && !words.empty()) {
        cut_name(words);
        if (names_within(path, words, literal))
            return true;
    }
    return false;
}

} // namespace

const std::vector<Explanation>& explanations() {
    static const Explanations all = make();
    return all;
}

bool explains(const Explanation& e, std::string_view path) {
    std::string_view pattern = e.path;
    while (!pattern.empty() && !path.empty()) {
        const std::string_view wanted = cut_name(pattern);
        const std::string_view name = cut_name(path);
        const bool any = wanted == "*" || (wanted == "*[]" && name.ends_with("[]"));
        if (!any && wanted != name)
            return false;
    }
    return pattern.empty() && path.empty();
}

bool is_named(const Explanation& e, std::string_view words) {
    return fmt::format(".{}.", plain(e.path)).find(fmt::format(".{}.", plain(words))) != std::string::npos;
}

bool is_named_within(const Explanation& e, std::string_view words) {
    for (std::string_view path = e.path; !path.empty(); cut_name(path))
        if (names_within(path, words, false))
            return true;
    return false;
}

std::vector<const Explanation*> find_explanations(std::string_view words) {
    std::vector<const Explanation*> out;
    for (const Explanation& e : explanations())
        if (is_named(e, words))
            out.push_back(&e);
    return out;
}

} // namespace sim
