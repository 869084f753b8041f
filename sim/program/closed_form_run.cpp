#include "sim/program/closed_form_run.h"

#include "razor/frame/frame.h"
#include "razor/image/output_file.h"
#include "razor/scene/error.h"
#include "sim/config/placement.h"
#include "sim/machine/json_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numeric>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

double seconds_of_processor() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_since(std::chrono::steady_clock::time_point t) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

/// Workers in the order of their stretches of the screen.
std::vector<Seat> seats_of(const Config& machine, int workers) {
    const Placement placement(machine.chip);
    const std::vector<int> places = placement.places(workers);
    const std::vector<int> trees = placement.trees(workers, machine.kdtree.share);
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return places[a] < places[b]; });
    std::vector<Seat> out;
    for (const std::size_t w : order)
        out.push_back({static_cast<int>(places[w] / machine.chip.threads), trees[w]});
    return out;
}

double seconds(const ClosedForm& f, const Config& machine) {
    return f.prediction.cycles * static_cast<double>(machine.chip.clock_ps) * 1e-12;
}

double line_bytes(const Config& machine) {
    return static_cast<double>(machine.last_cache().line_bytes);
}

} // namespace

std::string not_in_closed_form(const Config& machine) {
    if (machine.coherence.kept())
        return "one tile does not say what keeping plain data coherent between tiles takes";
    if (machine.chip.tiles > 1 && machine.beyond_tiles(machine.cache_levels() - 1))
        return "one tile does not say what others leave it of a cache beyond the tiles";
    return "";
}

ClosedForm compute_closed_form(const Config& machine, int workers, const razor::SceneDescription& scene,
                               const std::string& seed_file, bool quiet,
                               const std::atomic<bool>& interrupted) {
    const auto begin = std::chrono::steady_clock::now();
    const double processor = seconds_of_processor();
    const std::string scene_text = razor::to_toml(scene);
    ClosedForm out;
    const bool kept = !seed_file.empty() && std::filesystem::exists(seed_file);
    if (kept) {
        out.seed = read_seed("--seed-report", seed_file);
        check_seed("--seed-report", seed_file, out.seed, machine, scene_text);
    }
    const razor::Scene built = razor::build_scene(scene);
    if (!kept) {
        out.seed = make_seed(machine, built, scene_text, quiet, interrupted);
        out.made = true;
        if (!seed_file.empty())
            write_seed(seed_file, out.seed);
    }
    if (const int tiles = razor::screen_tiles(built.settings);
        out.seed.needs.size() != static_cast<std::size_t>(tiles))
        throw razor::UserError(fmt::format(
            "--seed-report: {}: needs are of {} screen tiles, but the picture has {}; make it anew",
            seed_file, out.seed.needs.size(), tiles));
    const std::vector<Seat> seats = seats_of(machine, workers);
    out.counted = count_screen(built, seats, out.seed.seed, out.seed.drivers, out.seed.needs, interrupted);
    const auto model = std::chrono::steady_clock::now();
    out.prediction = predict(out.seed.seed, out.seed.machine, machine, out.counted.work, seats);
    out.model_seconds = seconds_since(model);
    out.seconds = seconds_since(begin);
    out.processor_seconds = seconds_of_processor() - processor;
    return out;
}

std::string closed_form_text(const ClosedForm& f, const Config& machine, int workers) {
    const Prediction& p = f.prediction;
    std::string out = fmt::format("estimate               closed form: mean-value analysis of a closed "
                                  "network, from one simulated tile\n"
                                  "workers                {} on {} tiles x {} cores x {} threads\n"
                                  "\n{:<24} {:>15}   to some {:.0f} % either way\n",
                                  workers, machine.chip.tiles, machine.chip.cores, machine.chip.threads, "",
                                  "estimate", 100 * closed_form_error);
    const auto row = [&](const char* name, double value) {
        out += fmt::format("{:<24} {:>15.0f}\n", name, value);
    };
    row("cycles", p.cycles);
    row("instructions", p.instructions);
    row("bytes from and to DRAM", line_bytes(machine) * (p.reads + p.writes));
    row("lines read from DRAM", p.reads);
    row("lines written to DRAM", p.writes);
    row("rays a second", f.counted.rays / seconds(f, machine));
    out +=
        fmt::format("\nworkers at work {:.1f}, waiting for what others build {:.1f}, of {}; {:.1f} % of the "
                    "instructions are builds\n",
                    p.threads, p.waiting, workers, 100 * p.built / p.instructions);
    for (const StationUse& s : p.stations)
        out += fmt::format("{:<16} busy for {:5.1f} %   {}\n", s.name, 100 * s.utilisation, s.meaning);
    out += fmt::format(
        "limited by {}\n\nhost: {:.4f} s for the model, {:.3f} s to count work natively, {:.3f} s "
        "of processor time for the seed{}\n",
        p.limiter, f.model_seconds, f.counted.seconds, f.seed.processor_seconds,
        f.made ? "" : ", made before");
    return out;
}

json closed_form_json(const ClosedForm& f, const Config& machine, int workers) {
    const Prediction& p = f.prediction;
    const auto whole = [](double x) { return static_cast<std::uint64_t>(std::llround(x)); };
    json out;
    out["machine"] = json_of_configuration(machine);
    out["workers"] = workers;
    out["cycles"] = whole(p.cycles);
    out["seconds"] = seconds(f, machine);
    out["core"] = {{"instructions", whole(p.instructions)}};
    out["memory"] = {{"reads", whole(p.reads)}, {"writes", whole(p.writes)}};
    json stations = json::array();
    for (const StationUse& s : p.stations)
        stations.push_back({{"station", s.name}, {"utilisation", s.utilisation}});
    json figures = json::object();
    const auto figure = [&](const char* name, double value) {
        figures[name] = {{"value", value},
                         {"low", value * (1 - closed_form_error)},
                         {"high", value * (1 + closed_form_error)}};
    };
    figure("cycles", p.cycles);
    figure("dram_bytes", line_bytes(machine) * (p.reads + p.writes));
    figure("dram_reads", p.reads);
    figure("dram_writes", p.writes);
    out["estimate"] = {{"how", "closed form"},         {"figures", figures},
                       {"stations", stations},         {"limiter", p.limiter},
                       {"threads_at_work", p.threads}, {"threads_waiting", p.waiting},
                       {"once_cycles", p.once_cycles}, {"built_instructions", whole(p.built)}};
    out["renderer"] = {{"counters", {{"rays", f.counted.rays}}},
                       {"built",
                        {{"grid_bytes", f.counted.grid_bytes},
                         {"node_bytes", f.counted.node_bytes},
                         {"list_bytes", f.counted.list_bytes}}}};
    out["host"] = {{"seconds", f.seconds},
                   {"processor_seconds", f.processor_seconds},
                   {"model_seconds", f.model_seconds},
                   {"count_seconds", f.counted.seconds},
                   {"seed_processor_seconds", f.seed.processor_seconds},
                   {"seed_made", f.made},
                   {"instructions_per_second", p.instructions / f.seconds}};
    return out;
}

} // namespace sim
