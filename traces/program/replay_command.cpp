#include "traces/program/replay_command.h"

#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/replay/timed_replay.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"
#include "traces/program/analysis_options.h"
#include "traces/program/progress.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <thread>

namespace traces {

using analysis::Table;
using json = nlohmann::ordered_json;

namespace {

constexpr std::array<const char*, 4> by_names = {"all", "structure", "phase", "kind"};
constexpr double none = std::numeric_limits<double>::quiet_NaN(); // a dash

double ratio(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? none : static_cast<double>(part) / static_cast<double>(whole);
}

/// Rows of a group: each level of caches, and memory.
void add_rows(const sim::ReplayResult& result, const std::vector<Table::Cell>& head, const sim::Traffic& t,
              bool all, Table& table) {
    const sim::Report& r = result.report;
    const auto row = [&](std::vector<Table::Cell> cells) {
        cells.insert(cells.begin(), head.begin(), head.end());
        table.rows.push_back(std::move(cells));
    };
    for (unsigned level = 0; level < result.first_level; ++level)
        row({fmt::format("L{} (not driven)", level + 1), none, none, none, none, none, none, none, none,
             none});
    for (unsigned level = result.first_level; level < r.config.cache_levels(); ++level) {
        const sim::TrafficOfLevel& of = sim::traffic_of_level[level];
        const std::uint64_t reads = t.*of.reads, writes = t.*of.writes, misses = t.*of.misses;
        const sim::CacheCounters c = r.cache_total(level);
        const auto whole = [&](std::uint64_t n) { return all ? Table::Cell(n) : Table::Cell(none); };
        row({fmt::format("L{}", level + 1), reads, writes, reads + writes - misses, misses,
             ratio(misses, reads + writes), t.*of.write_backs, whole(c.fills),
             whole(c.prefetches + c.hardware_prefetches), none});
    }
    const sim::MemoryCounters& m = r.memory;
    const std::uint64_t bursts = m.row_hits + m.row_empties + m.row_conflicts;
    row({std::string("memory"), t.memory_reads, t.memory_writes, none, none, none, none, none, none,
         all ? ratio(m.row_hits, bursts) : none});
}

/// Of machines whose memory was driven alone: what it made of its requests. Times in nanoseconds.
Table memory_table(const std::vector<std::string>& machines, const std::vector<sim::ReplayResult>& results) {
    Table out;
    for (const char* name : {"machine", "row hits", "row empties", "row conflicts", "ns a read burst",
                             "of them queued", "ns before the queue", "buses busy", "GB/s", "us in all"})
        out.columns.emplace_back(name);
    for (std::size_t m = 0; m < machines.size(); ++m) {
        const sim::MemoryCounters& c = results[m].report.memory;
        const sim::MemoryConfig& memory = results[m].report.config.memory;
        const double clock_ns = static_cast<double>(memory.clock_ps) / 1000;
        const auto ns_of = [&](std::uint64_t clocks, std::uint64_t of) {
            return of == 0 ? none : clock_ns * static_cast<double>(clocks) / static_cast<double>(of);
        };
        const double all_ns = clock_ns * static_cast<double>(c.last_clock);
        const double bytes = static_cast<double>(c.read_bursts + c.write_bursts) *
                             static_cast<double>(memory.bus_bytes * memory.burst_length);
        out.rows.push_back({machines[m], c.row_hits, c.row_empties, c.row_conflicts,
                            ns_of(c.read_clocks, c.read_bursts), ns_of(c.queue_clocks, c.read_bursts),
                            ns_of(c.read_wait_clocks, c.read_bursts),
                            ratio(c.busy_clocks, c.last_clock * static_cast<std::uint64_t>(memory.channels)),
                            all_ns > 0 ? bytes / all_ns : none, all_ns / 1000});
    }
    return out;
}

/// The machine that the trace says it is of.
std::optional<sim::Config> recorded_on(const Description& about) {
    std::optional<sim::Config> config = sim::machine_of(about);
    if (config)
        config->sim.mode = "fast"; // which says when data came as well, for who waits for them
    return config;
}

} // namespace

void ReplayCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("replay", "what the memory systems of machines make of a trace");
    app_->add_option("TRACE", file_,
                     "a trace of any format, of what cores ask for, a level of caches passes on, or memory "
                     "is asked for; or -")
        ->required();
    app_->add_option("--from", from_, "its format; without it, as it begins or is named")
        ->type_name("FORMAT");
    app_->add_option(
            "--machine", machines_,
            "a machine, such as configs/machines/tiny.toml; behind it overrides of its own: "
            "tiny.toml,l2.size_bytes=65536; may be given more than once, for one pass over the trace")
        ->type_name("FILE[,KEY=VALUE...]")
        ->required()
        ->expected(1)
        ->take_all();
    app_->add_option("-g", settings_, "overrides a setting of all machines; may be given more than once")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
    app_->add_option("--by", by_, "tell counts apart by: all, structure, phase, kind (of work)")
        ->type_name("WHAT");
    app_->add_flag("--fetches", fetches_,
                   "fetches of instructions are reads, of unified caches; without it they are left out");
    app_->add_flag("--timed", timed_,
                   "references come when what they waited for in the run is there on this machine, which "
                   "moves what follows; without it, in the order and at the times of the run");
    app_->add_option("--against", against_,
                     "the report of a run (razor-sim run --json) of the same machine: how far the replay's "
                     "counts are from it")
        ->type_name("FILE.json");
    app_->add_option("--threads", threads_,
                     "of this host, that machines are spread on; without it, as many as there are")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    app_->add_option("--csv", csv_, "write the table for programs, whole or not at all; - is standard output")
        ->type_name("FILE");
    app_->add_option("--json", json_, "likewise all counters of all machines")->type_name("FILE");
}

std::vector<ReplayCommand::Machine> ReplayCommand::machines() const {
    std::vector<Machine> out;
    for (const std::string& text : machines_) {
        const std::vector<std::string> parts = split("--machine", text);
        std::vector<std::string> settings = settings_;
        settings.insert(settings.end(), parts.begin() + 1, parts.end());
        Machine m;
        try {
            m.description = sim::describe_machine(parts.front(), settings);
        } catch (const sim::ConfigError& e) { // which takes all for those of -g
            const std::string_view what = e.what();
            for (std::size_t i = 1; i < parts.size(); ++i)
                if (const std::string place = fmt::format("-g {}: ", parts[i]); what.starts_with(place))
                    throw Error(fmt::format("--machine {}: {}", text, what.substr(place.size())));
            throw;
        }
        m.label = m.description.name;
        for (std::size_t i = 1; i < parts.size(); ++i)
            m.label += " " + parts[i];
        out.push_back(std::move(m));
    }
    return out;
}

/// While machines work on a block, the next one is read.
std::vector<sim::ReplayResult> ReplayCommand::replay(Input& input, const std::vector<Machine>& all) const {
    struct Running {
        std::unique_ptr<sim::Replay> ordered; // or ...
        std::unique_ptr<sim::TimedReplay> timed;
        void add(const Block& block) { ordered ? ordered->add(block) : timed->add(block); }
        sim::ReplayResult finish(const Description& d) {
            return ordered ? ordered->finish(d) : timed->finish(d);
        }
    };
    const Description& about = input.description();
    const sim::ReplayOptions options{fetches_};
    const std::optional<sim::Config> of = timed_ ? recorded_on(about) : std::nullopt;
    std::vector<Running> replays;
    for (const Machine& m : all)
        if (timed_)
            replays.push_back({nullptr, std::make_unique<sim::TimedReplay>(
                                            m.description.config, of ? &*of : nullptr, about, options)});
        else
            replays.push_back({std::make_unique<sim::Replay>(m.description.config, about, options), nullptr});
    const std::size_t most =
        std::min(threads_ != 0 ? static_cast<std::size_t>(threads_)
                               : std::max<std::size_t>(1, std::thread::hardware_concurrency()),
                 replays.size());
    Progress progress;
    Block block, ahead;
    for (bool more = input.next(block); more; std::swap(block, ahead)) {
        check_interrupts();
        std::atomic<std::size_t> next{0};
        std::vector<std::exception_ptr> failed(most);
        {
            std::vector<std::jthread> workers;
            for (std::size_t w = 0; w < most; ++w)
                workers.emplace_back([&, w] {
                    try {
                        for (std::size_t i = next++; i < replays.size(); i = next++)
                            replays[i].add(block);
                    } catch (...) {
                        failed[w] = std::current_exception();
                    }
                });
            more = input.next(ahead);
        }
        for (const std::exception_ptr& f : failed)
            if (f)
                std::rethrow_exception(f);
        progress.add(block.size());
    }
    std::vector<sim::ReplayResult> out;
    for (Running& r : replays)
        out.push_back(r.finish(input.description()));
    return out;
}

Table ReplayCommand::table(const std::vector<Machine>& machines,
                           const std::vector<sim::ReplayResult>& results, By by) const {
    Table out;
    if (machines.size() > 1)
        out.columns.emplace_back("machine");
    if (by != By::all)
        out.columns.emplace_back(by_names[static_cast<std::size_t>(by)]);
    for (const char* name : {"level", "reads", "writes", "hits", "misses", "miss ratio", "write backs",
                             "fills", "prefetches", "row hits"})
        out.columns.emplace_back(name);
    for (std::size_t m = 0; m < machines.size(); ++m) {
        const sim::Report& r = results[m].report;
        std::map<std::size_t, sim::Traffic> groups;
        if (by == By::all)
            groups[0]; // also of nothing
        for (const sim::TrafficRow& t : r.traffic) {
            const std::size_t group = by == By::structure ? t.structure
                                      : by == By::phase   ? r.labels.phase(t.column)
                                      : by == By::kind    ? r.labels.kind(t.column)
                                                          : 0;
            for (const sim::TrafficColumn& c : sim::traffic_columns)
                groups[group].*c.count += t.traffic.*c.count;
        }
        for (const auto& [group, traffic] : groups) {
            std::vector<Table::Cell> head;
            if (machines.size() > 1)
                head.emplace_back(machines[m].label);
            if (by != By::all)
                head.emplace_back(by == By::structure ? r.structures[group]
                                  : by == By::phase   ? r.labels.phases[group]
                                                      : r.labels.kinds[group]);
            add_rows(results[m], head, traffic, by == By::all, out);
        }
    }
    return out;
}

/// What differs, the largest errors of totals first said in a line.
void ReplayCommand::compare(const std::vector<sim::Comparison>& all) const {
    Table out;
    out.columns = {"of", "counter", "replay", "run", "error"};
    std::size_t equal = 0;
    for (const sim::Comparison& c : all) {
        equal += c.replayed == c.run ? 1 : 0;
        const bool total = c.part.find('[') == std::string::npos && !c.part.starts_with("traffic");
        if (total && (c.replayed != 0 || c.run != 0))
            out.rows.push_back({c.part, c.counter, c.replayed, c.run, c.error()});
    }
    fmt::print("\n{} of {} counts are equal to those of {}{}\n\n{}", equal, all.size(), against_,
               equal == all.size() ? "" : "; errors are parts of the run's", out.text());
}

void ReplayCommand::give(const Input& input, const std::vector<Machine>& machines,
                         const std::vector<sim::ReplayResult>& results) const {
    const auto by = static_cast<By>(std::find(by_names.begin(), by_names.end(), by_) - by_names.begin());
    const Table rows = table(machines, results, by);
    const Description& d = input.description();
    const std::string note = input.note();
    std::vector<std::vector<sim::Comparison>> compared;
    if (!against_.empty()) {
        std::string text(std::size_t{1} << 20U, '\0'), report;
        const std::unique_ptr<Source> source = open_source(against_);
        while (const std::size_t n = source->read(text.data(), text.size()))
            report.append(text, 0, n);
        if (!json::accept(report))
            throw Error(fmt::format(
                "{}: is no report of a run, as it is no JSON; give what razor-sim run --json wrote",
                against_));
        compared.push_back(sim::compare_with_run(results.front(), report, against_));
    }
    std::vector<OutputFile> files;
    if (!csv_.empty())
        files.push_back({csv_, rows.csv()});
    if (!json_.empty()) {
        json out{{"analysis", "replay"}, {"trace", file_},           {"program", d.program},
                 {"level", d.level},     {"complete", note.empty()}, {"note", note}};
        for (std::size_t m = 0; m < machines.size(); ++m) {
            json one{{"label", machines[m].label}};
            one.update(json::parse(sim::print_replay(results[m])));
            out["machines"].push_back(std::move(one));
        }
        if (!compared.empty()) {
            json rows_of = json::array();
            for (const sim::Comparison& c : compared.front())
                if (c.replayed != 0 || c.run != 0)
                    rows_of.push_back({{"of", c.part},
                                       {"counter", c.counter},
                                       {"replay", c.replayed},
                                       {"run", c.run},
                                       {"error", c.run == 0 && c.replayed != 0 ? json() : json(c.error())}});
            out["against"] = {{"report", against_}, {"counts", std::move(rows_of)}};
        }
        files.push_back({json_, out.dump(2, ' ', false, json::error_handler_t::replace) + "\n"});
    }
    check_interrupts();
    write_files(files);
    if (csv_ != "-" && json_ != "-") {
        for (std::size_t m = 0; m < machines.size(); ++m) {
            const sim::ReplayResult& r = results[m];
            std::string left_out;
            for (std::size_t k = 0; k < r.left_out.size(); ++k)
                if (r.left_out[k] != 0)
                    left_out += fmt::format("; {} {} references are left out", r.left_out[k], kind_names[k]);
            fmt::print(
                "{}: {} references{}{}{}\n", machines[m].label, r.references,
                r.timed
                    ? fmt::format(", each when what it waited for was there: up to {} cycles later", r.delay)
                : r.windows ? ", each at its cycle and in the run's windows"
                : r.waits == 0
                    ? ", each at its time"
                    : fmt::format(", {} of which found no room: all came {} cycles later in the end", r.waits,
                                  r.delay),
                r.ended || r.memory_alone ? "" : "; what caches have changed stays there", left_out);
        }
        if (!d.filters.empty() || d.sample < 1)
            fmt::print("The trace is of a part alone: {}{}\n", d.filters,
                       d.sample < 1 ? fmt::format("{}a fraction {:g} of all lines",
                                                  d.filters.empty() ? "" : "; ", d.sample)
                                    : "");
        fmt::print("\n{}", rows.text());
        if (results.front().memory_alone) {
            std::vector<std::string> labels;
            for (const Machine& m : machines)
                labels.push_back(m.label);
            fmt::print("\n{}", memory_table(labels, results).text());
        }
        if (!compared.empty())
            compare(compared.front());
    }
    if (d.level.empty())
        fmt::print(stderr,
                   "razor-trace: {}: does not say where references were seen; they pass for those of "
                   "cores\n",
                   file_);
    if (!note.empty())
        fmt::print(stderr, "razor-trace: {}\n", note);
}

void ReplayCommand::run() {
    if (std::find(by_names.begin(), by_names.end(), by_) == by_names.end())
        throw Error(fmt::format("--by {}: there is no such thing; give all, structure, phase, kind", by_));
    if (!against_.empty() && machines_.size() > 1)
        throw Error("--against: is of one machine; give one --machine");
    try {
        const std::vector<Machine> all = machines();
        std::vector<std::string> inputs{file_, against_};
        for (const Machine& m : all)
            inputs.insert(inputs.end(), m.description.files.begin(), m.description.files.end());
        check_apart({csv_, json_}, inputs);
        auto source = open_source(file_);
        const Format& format = format_of_input(from_, file_, *source);
        const std::unique_ptr<Input> input = format.read(std::move(source));
        const std::vector<sim::ReplayResult> results = replay(*input, all);
        give(*input, all, results);
    } catch (const sim::ConfigError& e) {
        throw Error(e.what());
    }
}

} // namespace traces
