#include "sim/program/run_command.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/program/progress.h"
#include "razor/scene/mesh_error.h"
#include "razor/scene/text_file.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"
#include "sim/config/placement.h"
#include "sim/machine/intervals.h"
#include "sim/machine/machine.h"
#include "sim/program/calibration.h"
#include "sim/program/estimates.h"
#include "sim/program/frame_report.h"
#include "sim/program/native_run.h"
#include "sim/program/provenance.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <cmath>
#include <optional>
#include <thread>
#include <tuple>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

/// Looks at the frame from a host thread of its own: progress on a terminal.
class Watch {
public:
    Watch(const razor::Frame& frame, razor::Progress& progress)
        : thread_([&](const std::stop_token& stop) {
              while (!stop.stop_requested()) {
                  progress.show(frame.progress());
                  std::this_thread::sleep_for(std::chrono::milliseconds(50));
              }
          }) {}

private:
    std::jthread thread_;
};

} // namespace

MachineDescription noted_machine(const std::string& file, const std::vector<std::string>& settings) {
    MachineDescription out = describe_machine(file, settings);
    for (const std::string& one : out.files)
        razor::note_input(one);
    return out;
}

void MachineOptions::add_to(CLI::App& app) {
    app.add_option("--machine", file, "the machine, such as configs/machines/tiny.toml")
        ->type_name("FILE")
        ->required();
    app.add_option("-g", settings, "overrides a setting of the machine; may be given more than once")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
}

void RunCommand::add_to(CLI::App& app) {
    CLI::App& run = *app.add_subcommand("run", "render a frame on a simulated machine");
    machine_.add_to(run);
    scene_.add_to(run, "--scene");
    run.add_option("-o,--output", outputs_,
                   "the picture: .exr (all layers) or .png; may be given more than once")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    run.add_option("--json", json_, "write the report for programs, with the resolved configuration")
        ->type_name("FILE.json");
    run.add_option("--report", report_, "write the readable report here instead of printing it")
        ->type_name("FILE.txt");
    run.add_option("--workers", workers_, "workers; without it, one a hardware thread")->type_name("N");
    run.add_option(
           "--share", share_,
           "who shares a kd-tree: chip (all), tile, core, worker (nobody), or N neighbouring workers; "
           "without it, as the machine file says (kdtree.share)")
        ->type_name("WHO");
    run.add_option(
           "--memory", memory_,
           "what grids, kd nodes and item lists may take in all, such as 4MiB; what was used longest ago "
           "is dropped and made again; without it, no bound")
        ->type_name("SIZE");
    run.add_option("--intervals", intervals_,
                   "write a time series: a row of work, misses, traffic and stalls for each --interval")
        ->type_name("FILE.csv");
    run.add_option("--interval", interval_,
                   "cycles of a row of --intervals, rounded up to whole windows; without it, 100000")
        ->type_name("CYCLES");
    run.add_option(
           "--frames", frames_,
           "render the frame so many times in one run and count the last alone: caches, predictors and "
           "topology pages are warm, all else is built anew; without it, 1")
        ->type_name("N");
    run.add_option(
           "--tiles", tiles_,
           "count these screen tiles of 8 x 8 pixels alone, numbered from 0 along the curve by which workers "
           "take them (each beside the one before): those before them "
           "are rendered first, by all workers, and what they leave in caches and trees is there; those "
           "after them are not rendered; without it, all")
        ->type_name("FIRST..LAST");
    run.add_flag("--tiles-in-rows", tiles_in_rows_,
                 "number and render screen tiles row by row, to compare with the order along a curve");
    run.add_option("--jitter", jitter_,
                   "seed of noise: each line that an L1 asks for is asked for 0 or 1 cycle later; runs that "
                   "differ in the seed alone say how far results must lie apart to mean anything; 0: none; "
                   "without it, as the machine file says (sim.jitter)")
        ->type_name("SEED");
    run.add_option(
           "--host-threads", host_threads_,
           "threads of the host that tiles run on, which changes no digit of the report; without it, 1")
        ->type_name("N");
    run.add_option(
           "--estimate", estimate_,
           "sample:FRACTION estimates from so much of the time, simulated in detail; elsewhere caches "
           "are only warmed; every figure comes with its error. closed-form computes the chip as a network "
           "of "
           "queues, from one simulated tile")
        ->type_name("HOW");
    run.add_option("--estimate-seed", seed_, "where samples are taken; without it, 1")->type_name("SEED");
    run.add_option(
           "--seed-report", seed_report_,
           "what --estimate closed-form knows of one tile: read if it is there, else made and kept, for "
           "other numbers of tiles and threads, clocks, latencies of caches and memories")
        ->type_name("FILE.json");
    add_fidelity_to(run);
    trace_.add_to(run);
    costs_.add_to(run);
    sharing_.add_to(run);
    run.add_flag("--no-native", no_native_,
                 "do not render the frame natively as well, to compare time and picture");
    run.add_flag("--no-calibration", no_calibration_,
                 "do not read and show what the machine's file names as its calibration");
    run.add_flag("--quiet", quiet_, "show no progress");
}

/// How the run is to be sampled, if it is.
std::optional<Sampling> RunCommand::sampling(const Machine& machine) const {
    if (estimate_.empty()) {
        if (!seed_.empty())
            throw razor::UserError("--estimate-seed is of no use without --estimate; give both");
        return std::nullopt;
    }
    if (in_closed_form())
        return std::nullopt;
    Sampling s = parse_sampling("--estimate", estimate_);
    if (!seed_.empty())
        s.seed = static_cast<std::uint32_t>(razor::parse_whole("--estimate-seed", seed_, {0, 1e9}));
    if (const std::string why = machine.not_sampled(); !why.empty())
        throw razor::UserError(
            fmt::format("--estimate: runs of this machine are not sampled: {}; leave it out, or "
                        "give another machine",
                        why));
    const std::pair<const char*, bool> others[] = {
        {"--intervals", !intervals_.empty()}, {"--frames", !frames_.empty()},
        {"--tiles", !tiles_.empty()},         {"--host-threads", !host_threads_.empty()},
        {"--trace", trace_.wanted()},         {"--costs and --false-colour", costs_.given()},
        {"--sharing", sharing_.wanted()}};
    for (const auto& [option, given] : others)
        if (given)
            throw razor::UserError(fmt::format(
                "--estimate samples one whole frame, on one thread of the host; leave out {}", option));
    return s;
}

int RunCommand::run() const {
    std::vector<std::string> settings = machine_.settings;
    if (!share_.empty()) {
        Config any;
        const std::string wrong = set_text(*find_parameter("kdtree.share"), any, share_);
        if (!wrong.empty())
            throw ConfigError("--share: " + wrong);
        settings.push_back("kdtree.share=" + share_);
    }
    if (!jitter_.empty())
        settings.push_back(
            fmt::format("sim.jitter={}", razor::parse_whole("--jitter", jitter_, {0, 2147483647})));
    const MachineDescription machine_description = noted_machine(machine_.file, settings);
    const std::optional<Calibration> calibration =
        no_calibration_ ? std::nullopt : read_calibration(machine_description);
    const Config& config = machine_description.config;
    const Machine machine(config);
    const double most = machine.threads();
    const int workers =
        workers_.empty() ? machine.threads() : razor::parse_whole("--workers", workers_, {1, most});
    const std::vector<int> trees = Placement(config.chip).trees(workers, config.kdtree.share);
    const int host_threads =
        host_threads_.empty() ? 1 : razor::parse_whole("--host-threads", host_threads_, {1, 1024});
    const std::uint64_t memory = memory_.empty() ? 0 : razor::parse_bytes("--memory", memory_);
    RunOptions run_options;
    if (intervals_.empty() && !interval_.empty())
        throw razor::UserError("--interval is of no use without --intervals FILE.csv; give both");
    if (!intervals_.empty())
        run_options.interval = static_cast<std::uint64_t>(
            interval_.empty() ? 100000 : razor::parse_whole("--interval", interval_, {1000, 1e9}));
    run_options.frames = frames_.empty() ? 1 : razor::parse_whole("--frames", frames_, {1, 1000});
    const razor::SceneDescription description = scene_.describe();
    if (description.settings.noise_threshold > 0) {
        throw razor::UserError(
            "a noise threshold takes samples in passes, and the machine renders a frame in one "
            "go; give --noise-threshold 0");
    }
    Counted counted;
    counted.last_tile = razor::screen_tiles(description.settings) - 1;
    if (!tiles_.empty()) {
        std::tie(counted.first_tile, counted.last_tile) =
            razor::parse_span("--tiles", tiles_, {0, static_cast<double>(counted.last_tile)});
    }
    if (!fidelity_.empty() || !error_.empty())
        return run_fidelity(wanted_error(), settings, workers, description);
    if (in_closed_form()) {
        check_closed_form(config);
        return run_closed_form(machine_description, workers, description);
    }
    if (!seed_report_.empty())
        throw razor::UserError("--seed-report is of no use without --estimate closed-form; give both");
    const std::optional<Sampling> sampling = this->sampling(machine);
    const bool estimated = sampling && sampling->fraction < 1;
    const std::string scene = razor::to_toml(description);
    TraceSettings trace = trace_.settings();
    std::optional<LineSharing> sharing = sharing_.begin();
    if (sharing && trace_.wanted())
        throw razor::UserError(
            "--sharing and --trace both look at what cores access; give them to runs of their "
            "own, which are alike to the cycle");
    std::vector<std::filesystem::path> written(outputs_.begin(), outputs_.end());
    written.insert(written.end(), {json_, report_, intervals_, trace_.file()});
    razor::check_apart(written);
    for (const std::string& output : outputs_)
        razor::check_output(output);
    costs_.check(outputs_, config.cache_levels());
    for (const std::string& file : {json_, report_, intervals_, trace_.file()})
        if (!file.empty())
            razor::check_writable(file);

    const std::atomic<bool>& interrupted = razor::watch_interrupts();
    const razor::Scene built = razor::build_scene(description);
    razor::Frame frame = razor::naming_files(description, [&] {
        return razor::Frame(built, {.workers = workers,
                                    .tree_of_worker = trees,
                                    .place_of_worker = Placement(config.chip).places(workers),
                                    .tiles_in_rows = tiles_in_rows_,
                                    .memory_bytes = memory,
                                    .apart = true,
                                    .discards = config.renderer.discard == "on"});
    });
    const Labels labels{{std::begin(razor::phase_names), std::end(razor::phase_names)},
                        {std::begin(razor::kind_names), std::end(razor::kind_names)}};
    run_options.stop = &interrupted;
    // A frame ends with the last tile that counts, and its last part begins with the first one.
    const auto begin_frame = [&](int n) {
        const bool split = n + 1 == run_options.frames && counted.first_tile > 0;
        frame.take_tiles(0, split ? counted.first_tile : counted.last_tile + 1);
    };
    begin_frame(0);
    run_options.next_frame = [&](int n) {
        frame.reset();
        begin_frame(n);
    };
    if (counted.first_tile > 0) {
        run_options.next_part = [&] {
            counted.before = frame.statistics().by_kind;
            frame.take_tiles(counted.first_tile, counted.last_tile + 1);
        };
    }
    Estimate estimate;
    if (sampling) {
        run_options.sampling = &*sampling;
        run_options.estimate = &estimate;
    }
    std::optional<OwnerCosts> pixel_costs;
    if (costs_.given())
        run_options.owners = &pixel_costs.emplace(building_phases());
    std::optional<Recorder> recorder;
    if (trace_.wanted()) {
        trace.program = fmt::format("razor-sim {}", razor::version());
        trace.configuration = print_machine(machine_description) + "\n# scene\n" + scene;
        trace.picture = {static_cast<std::uint32_t>(description.settings.width),
                         static_cast<std::uint32_t>(description.settings.height), razor::tile_side};
        recorder.emplace(std::move(trace), config, traces::open_sink(trace_.file()));
    } else if (sharing) {
        recorder.emplace(config, *sharing);
    }
    if (recorder)
        run_options.recorder = &*recorder;
    Report report;
    std::optional<NativeRun> native;
    try {
        {
            razor::Progress progress(!quiet_);
            const Watch watch(frame, progress);
            report = machine.run(
                frame.memory(), workers, labels,
                [&](int worker) { frame.render(razor::simulated::kernels, worker); }, host_threads,
                run_options);
        }
        if (!no_native_)
            native = run_native(built, frame.film(), interrupted, counted.last_tile + 1, tiles_in_rows_);
    } catch (const Stopped&) {
        // said below
    } catch (const razor::Cancelled&) {
        // likewise
    }
    if (interrupted.load()) {
        fmt::print(stderr, "razor-sim: interrupted; nothing written\n");
        return razor::interrupted_exit;
    }
    // Edges of 2^level, of the frame's units until here.
    for (TrafficRow& row : report.traffic)
        if (row.level)
            *row.level += std::ilogb(frame.unit());
    if (native && !native->equal && !native->unfused)
        throw std::logic_error(fmt::format(
            "the simulated picture differs from that of {}; please report this command", native->isa));

    if (estimated)
        report.cycles = static_cast<std::uint64_t>(std::llround(estimate.cycles.value));
    const razor::FrameStatistics statistics = frame.statistics();
    const razor::OutputGuard guard;
    const razor::ImageAttributes attributes{{"razor.version", std::string(razor::version())},
                                            {"razor.scene", scene},
                                            {"razor.isa", razor::simulated::kernels.name}};
    razor::Film film = frame.film();
    if (pixel_costs)
        PixelCostOptions::add_layers(film, *pixel_costs, config);
    const razor::Film colours = costs_.shows() ? costs_.shown(film) : razor::Film();
    for (const std::string& output : outputs_)
        razor::write_image(output, costs_.shows() && razor::is_png(output) ? colours : film, attributes);
    if (sharing)
        sharing->check(report);
    else if (recorder)
        recorder->finish();
    if (!intervals_.empty())
        razor::write_text_file(intervals_, print_intervals(report));
    if (!json_.empty()) {
        json out{{"program", "razor-sim"},
                 {"version", razor::version()},
                 {"options",
                  {{"workers", workers},
                   {"share", config.kdtree.share},
                   {"frames", run_options.frames},
                   {"memory_bytes", memory},
                   {"tiles", {counted.first_tile, counted.last_tile}}}},
                 {"scene", scene}};
        json run = estimated ? sampled_json(report, estimate, *sampling) : json::parse(print_json(report));
        json host = run["host"];
        run.erase("host");
        out.update(run);
        out["machine_provenance"] = provenance_json(machine_description);
        if (sharing)
            out["sharing"] = sharing_json(*sharing, report);
        if (calibration)
            out["calibration"] = calibration_json(*calibration);
        out["renderer"] = renderer_json(statistics, counted.of(statistics), frame.duplicates(), trees);
        out["renderer"]["screen_tiles"] = counted.tiles();
        if (memory != 0)
            out["renderer"]["memory"] = frame.budget();
        host["topology_page_seconds"] = statistics.page_seconds;
        if (native)
            host["native"] = native_json(*native, report.host_seconds);
        host["code_bytes"] = code_json(frame.plan());
        out["host"] = host;
        razor::write_json_file(json_, out);
    }
    const std::string text =
        provenance_text(machine_description) + (calibration ? calibration_text(*calibration) : "") +
        frame_text(description.settings, workers, counted, statistics, frame.budget(), report) +
        (estimated ? sampled_text(report, estimate, *sampling) : print_text(report)) +
        (pixel_costs ? costs_.text(report, film) : "") +
        (sharing    ? sharing_text(*sharing, report)
         : recorder ? trace_.text(*recorder)
                    : "") +
        (native ? native_text(*native, report.host_seconds) : "") + code_text(frame.plan());
    give(text);
    return 0;
}

void RunCommand::give(const std::string& report) const {
    if (report_.empty())
        fmt::print("{}", report);
    else
        razor::write_text_file(report_, report);
}

} // namespace sim
