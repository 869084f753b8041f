#include "sim/program/seed_run.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/program/progress.h"
#include "razor/scene/error.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/program/frame_run.h"
#include "sim/program/screen_work.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

} // namespace

KeptSeed make_seed(const Config& machine, const razor::Scene& scene, const std::string& scene_text,
                   bool quiet, const std::atomic<bool>& interrupted) {
    KeptSeed out;
    out.machine = machine;
    out.machine.chip.tiles = 1;
    out.scene = scene_text;
    const int threads = static_cast<int>(out.machine.all_threads());
    const int tiles = razor::screen_tiles(scene.settings);
    razor::Progress progress(!quiet);
    const FrameRun crowded = run_frame(out.machine, scene, threads, 0, tiles, interrupted);
    progress.show(0.8);
    // The middle of the curve shows more than its ends; an eighth says what instructions take.
    const int some = std::max(1, tiles / 8), first = (tiles - some) / 2;
    const FrameRun lone = run_frame(out.machine, scene, 1, first, first + some, interrupted);
    out.seed = seed_of(crowded.report, lone.report, once_a_frame(), std::min(threads, tiles));
    out.drivers = drivers(crowded.statistics.counters, static_cast<double>(crowded.statistics.inner_nodes));
    out.processor_seconds = crowded.report.processor_seconds + lone.report.processor_seconds;
    return out;
}

void write_seed(const std::string& file, const KeptSeed& seed) {
    const json out = {{"program", "razor-sim"},
                      {"version", razor::version()},
                      {"kind", "seed of closed forms"},
                      {"machine", print_machine(seed.machine)},
                      {"scene", seed.scene},
                      {"drivers", seed.drivers},
                      {"seed", json_of_seed(seed.seed)},
                      {"host", {{"processor_seconds", seed.processor_seconds}}}};
    razor::write_text_file(file, out.dump(2) + "\n");
}

KeptSeed read_seed(const std::string& option, const std::string& file) {
    std::ifstream in(file);
    if (!in)
        throw razor::UserError(
            fmt::format("{}: cannot read {}; give a seed, or a name for a new one", option, file));
    try {
        const json from = json::parse(in);
        KeptSeed out;
        if (from.at("kind") != "seed of closed forms")
            throw razor::UserError(
                fmt::format("{}: {} is no seed; leave it out, or name a new file", option, file));
        out.machine = parse_machine(from.at("machine").get<std::string>(), file);
        out.scene = from.at("scene").get<std::string>();
        out.drivers = from.at("drivers").get<std::vector<double>>();
        out.seed = seed_of_json(from.at("seed"));
        out.processor_seconds = from.at("host").at("processor_seconds").get<double>();
        if (out.drivers.size() != razor::phase_count || out.seed.phases.size() < out.drivers.size())
            throw razor::UserError(
                fmt::format("{}: {} is of another version's phases; make it anew", option, file));
        return out;
    } catch (const nlohmann::json::exception&) {
        throw razor::UserError(
            fmt::format("{}: {} is no seed; leave it out, or name a new file", option, file));
    } catch (const ConfigError& error) {
        throw razor::UserError(fmt::format("{}: {}; make the seed anew", option, error.what()));
    }
}

void check_seed(const std::string& option, const std::string& file, const KeptSeed& seed,
                const Config& machine, const std::string& scene_text) {
    if (const std::string key = unknown_to_seed(seed.machine, machine); !key.empty())
        throw razor::UserError(
            fmt::format("{}: {} is another in {}'s machine, and a seed cannot know what that "
                        "does to misses and instructions; make a seed of this machine",
                        option, key, file));
    if (seed.scene != scene_text)
        throw razor::UserError(
            fmt::format("{}: {} is of another scene, or of other settings of it; make a seed "
                        "of this one",
                        option, file));
}

} // namespace sim
