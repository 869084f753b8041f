#include "sim/program/dram_table.h"

#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "sim/memory/dram_bounds.h"
#include "sim/memory/dram_load.h"
#include "sim/program/run_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

struct Controller {
    const char* name;
    DramOutcome (*run)(const Config&, const DramStream&, const DramLoad&, bool);
};
constexpr Controller controllers[] = {{"immediate", run_dram_immediate}, {"queued", run_dram_queued}};

struct Row {
    const char* controller;
    std::string stream;
    double load, host_seconds; // load: of the peak; 0: as fast as the memory answers
    DramOutcome outcome;
};

class Units {
public:
    explicit Units(const Config& c) : clock_ns_(static_cast<double>(c.memory.clock_ps) * 1e-3) {}
    double gigabytes(double bytes_per_clock) const { return bytes_per_clock / clock_ns_; }
    double ns(double clocks) const { return clocks * clock_ns_; }

private:
    double clock_ns_;
};

void print_row(const Row& r, const Units& unit) {
    const DramOutcome& o = r.outcome;
    const MemoryCounters& n = o.counters;
    double bursts = std::max(static_cast<double>(n.read_bursts + n.write_bursts), 1.0) / 100;
    fmt::print("{:<10} {:>6} {:>8.2f} {:>8.1f} {:>7.1f} {:>7.1f} {:>7.1f} {:>8.1f} {:>6.1f} {:>6.1f} "
               "{:>9.1f} {:>9.2f}\n",
               r.controller, r.load == 0 ? "most" : fmt::format("{:.0f} %", 100 * r.load),
               unit.gigabytes(o.bytes_per_clock), unit.ns(o.mean), unit.ns(o.median), unit.ns(o.p95),
               unit.ns(o.p99), unit.ns(o.longest), static_cast<double>(n.row_hits) / bursts,
               static_cast<double>(n.row_empties) / bursts, static_cast<double>(n.row_conflicts) / bursts,
               static_cast<double>(o.requests) * 1e-6 / std::max(r.host_seconds, 1e-9));
}

json to_json(const Row& r, const Units& unit) {
    const DramOutcome& o = r.outcome;
    json counters;
    for (const auto& row : memory_counters)
        counters[row.name] = o.counters.*row.count;
    return {{"controller", r.controller},
            {"stream", r.stream},
            {"load", r.load == 0 ? json() : json(r.load)},
            {"requests", o.requests},
            {"clocks", o.clocks},
            {"gigabytes_per_second", unit.gigabytes(o.bytes_per_clock)},
            {"latency_ns",
             {{"mean", unit.ns(o.mean)},
              {"median", unit.ns(o.median)},
              {"p95", unit.ns(o.p95)},
              {"p99", unit.ns(o.p99)},
              {"longest", unit.ns(o.longest)}}},
            {"counters", counters}};
}

/// The memory that is asked for, behind lines of 64 bytes unless a machine says otherwise.
Config configuration(const std::string& machine, const std::string& preset,
                     std::vector<std::string> settings) {
    if (!preset.empty()) {
        Config any;
        if (const std::string wrong = set_text(*find_parameter("memory.preset"), any, preset); !wrong.empty())
            throw ConfigError("--preset: " + wrong);
        settings.insert(settings.begin(), "memory.preset=" + preset);
    }
    return machine.empty() ? describe_machine_text("", "the default machine", settings).config
                           : noted_machine(machine, settings).config;
}

} // namespace

void DramTable::add_to(CLI::App& app) {
    CLI::App& dram = *app.add_subcommand(
        "dram",
        "try a memory by itself: bandwidth and latency of streams at several loads, beside closed forms");
    dram.add_option("--preset", preset_, "the memory, as memory.preset")->type_name("NAME");
    dram.add_option("--machine", machine_, "the memory of this machine")->type_name("FILE");
    dram.add_option("-g", settings_, "overrides a setting of the machine; may be given more than once")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
    std::string kinds;
    for (const DramStreamKind& k : dram_stream_kinds())
        kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : "; ", k.name, k.meaning);
    dram.add_option("--stream", streams_, "what is requested: " + kinds + "; without it, all of them")
        ->type_name("KIND")
        ->expected(1)
        ->take_all();
    dram.add_option(
            "--load", loads_,
            "requests wanted, as a part of the peak bandwidth; may be given more than once; without it "
            "0.1, 0.3, 0.5, 0.7 and 0.9. As fast as the memory answers comes always")
        ->type_name("PART")
        ->expected(1)
        ->take_all();
    dram.add_option(
            "--controller", controller_,
            "immediate (answers when a request comes: the fast mode's), queued (chooses from queues) or both")
        ->type_name("WHICH");
    dram.add_option("--requests", requests_, "lines a row of the table")->type_name("N");
    dram.add_option("--in-flight", in_flight_, "reads under way at once, at most, for each channel")
        ->type_name("N");
    dram.add_option("--mebibytes", bytes_, "of memory that is used")->type_name("N");
    dram.add_option("--stride", stride_,
                    "bytes from one request to the next of a strided stream; without it, 4096")
        ->type_name("N");
    dram.add_option("--seed", seed_, "of random addresses and times")->type_name("N");
    dram.add_option("--json", json_, "write the results for programs")->type_name("FILE.json");
}

int DramTable::run() const {
    auto whole = [](const char* option, const std::string& text, double least, double most) {
        return static_cast<std::uint64_t>(razor::parse_whole(option, text, {least, most}));
    };
    const Config config = configuration(machine_, preset_, settings_);
    const MemoryConfig& m = config.memory;
    constexpr std::string_view choices[] = {"immediate", "queued", "both"};
    const std::size_t which = razor::parse_choice("--controller", controller_, choices);
    DramLoad load;
    load.requests = whole("--requests", requests_, 1, 1e8);
    load.in_flight = whole("--in-flight", in_flight_, 1, 100000) * static_cast<std::uint64_t>(m.channels);
    load.seed = whole("--seed", seed_, 0, 2e9);
    const std::uint64_t bytes = whole("--mebibytes", bytes_, 1, 1e6) << 20;
    const std::uint64_t stride = stride_.empty() ? 4096 : whole("--stride", stride_, 1, 2e9);
    std::vector<double> loads;
    for (const std::string& text : loads_)
        loads.push_back(razor::parse_number("--load", text, {1e-6, 1}));
    if (loads_.empty())
        loads = {0.1, 0.3, 0.5, 0.7, 0.9};
    loads.push_back(0);
    std::vector<std::string> streams = streams_;
    if (streams.empty())
        for (const DramStreamKind& k : dram_stream_kinds())
            streams.emplace_back(k.name);
    for (const std::string& s : streams)
        make_dram_stream(s, config, bytes, stride, 0);
    if (!stride_.empty() && std::find(streams.begin(), streams.end(), "strided") == streams.end())
        throw razor::UserError("--stride is of a strided stream; give --stream strided too, or leave it out");
    if (!json_.empty())
        razor::check_writable(json_);

    const Units unit(config);
    const double peak = dram_peak(m), line = static_cast<double>(config.last_cache().line_bytes);
    fmt::print("{}: {} channels of {} ranks of {} banks, {:.2f} GB/s at most; each figure is of {} lines of "
               "{} bytes, {} reads "
               "under way at most\n",
               m.preset, m.channels, m.ranks, m.bank_groups * m.banks, unit.gigabytes(peak), load.requests,
               config.last_cache().line_bytes, load.in_flight);
    std::vector<Row> rows;
    json bounds = json::array();
    for (const std::string& s : streams) {
        const DramBound bound = dram_bandwidth_bound(config, s);
        const bool by_rows = std::string_view(bound.by).substr(0, 3) != "bus"; // where each line opens one
        fmt::print("\n{}: no more than {:.2f} GB/s by the {}{}", s, unit.gigabytes(bound.bytes_per_clock),
                   bound.by, by_rows ? " where no row is hit" : "");
        json closed{
            {"stream", s}, {"gigabytes_per_second", unit.gigabytes(bound.bytes_per_clock)}, {"by", bound.by}};
        if (s == "random" && m.page_policy == "open" && m.refresh == "all-bank") {
            double idle = unit.ns(dram_idle_latency(config, line / (peak * loads.front())));
            fmt::print("; an idle memory takes {:.1f} ns at the first load", idle);
            closed["idle_latency_ns"] = idle;
        }
        bounds.push_back(closed);
        fmt::print("\n{:<10} {:>6} {:>8} {:>8} {:>7} {:>7} {:>7} {:>8} {:>6} {:>6} {:>9} {:>9}\n",
                   "controller", "load", "GB/s", "mean ns", "median", "95 %", "99 %", "longest", "hit %",
                   "miss %", "conflict%", "M req/s");
        for (std::size_t c = 0; c < std::size(controllers); ++c)
            for (double part : loads) {
                if (which != c && which != 2)
                    continue;
                load.gap = part == 0 ? 0 : line / (peak * part);
                std::clock_t begin = std::clock();
                DramOutcome o = controllers[c].run(
                    config, make_dram_stream(s, config, bytes, stride, load.seed), load, false);
                double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
                rows.push_back({controllers[c].name, s, part, seconds, std::move(o)});
                print_row(rows.back(), unit);
            }
    }
    if (json_.empty())
        return 0;
    json out{{"program", "razor-sim dram"},
             {"version", razor::version()},
             {"preset", m.preset},
             {"peak_gigabytes_per_second", unit.gigabytes(peak)},
             {"in_flight", load.in_flight},
             {"closed_forms", bounds},
             {"machine", print_machine(config)}};
    double host = 0;
    for (const Row& r : rows) {
        out["rows"].push_back(to_json(r, unit));
        host += r.host_seconds;
    }
    out["host"] = {{"processor_seconds", host}};
    razor::write_json_file(json_, out);
    return 0;
}

} // namespace sim
