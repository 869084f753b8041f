// razor-sim run --fidelity auto: its options, and what it writes.
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "sim/program/calibration.h"
#include "sim/program/estimates.h"
#include "sim/program/fidelity.h"
#include "sim/program/frame_report.h"
#include "sim/program/provenance.h"
#include "sim/program/run_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace sim {

using json = nlohmann::ordered_json;

void RunCommand::add_fidelity_to(CLI::App& run) {
    run.add_option(
           "--fidelity", fidelity_,
           "auto tries ways to simulate from cheap to dear (closed form, where --seed-report names a seed; "
           "samples; the fast mode; the reference mode), and keeps the first whose own error is within "
           "--error; the report says what was chosen and why")
        ->type_name("auto");
    run.add_option("--error", error_,
                   "of --fidelity auto: the largest relative error of cycles and of bytes from and to DRAM, "
                   "beside the "
                   "reference mode; 0: that itself")
        ->type_name("E");
}

double RunCommand::wanted_error() const {
    if (fidelity_.empty())
        throw razor::UserError("--error is of no use without --fidelity auto; give both");
    if (fidelity_ != "auto")
        throw razor::UserError(
            fmt::format("--fidelity: \"{}\" is no fidelity; give auto, or choose a mode by "
                        "-g sim.mode and --estimate",
                        razor::printable(fidelity_, 100)));
    if (error_.empty())
        throw razor::UserError(
            "--fidelity auto needs an error that it is to meet; give --error E, such as 0.05");
    const double error = razor::parse_number("--error", error_, {0, 1});
    const std::pair<const char*, bool> others[] = {{"-o", !outputs_.empty()},
                                                   {"--estimate", !estimate_.empty()},
                                                   {"--estimate-seed", !seed_.empty()},
                                                   {"--intervals", !intervals_.empty()},
                                                   {"--frames", !frames_.empty()},
                                                   {"--tiles", !tiles_.empty()},
                                                   {"--tiles-in-rows", tiles_in_rows_},
                                                   {"--memory", !memory_.empty()},
                                                   {"--host-threads", !host_threads_.empty()},
                                                   {"--trace", trace_.wanted()},
                                                   {"--costs and --false-colour", costs_.given()},
                                                   {"--sharing", sharing_.wanted()}};
    for (const auto& [option, given] : others)
        if (given)
            throw razor::UserError(fmt::format(
                "--fidelity auto looks for cycles and bytes of one whole frame; leave out {}", option));
    return error;
}

int RunCommand::run_fidelity(double wanted, const std::vector<std::string>& settings, int workers,
                             const razor::SceneDescription& scene) const {
    razor::check_apart({json_, report_});
    for (const std::string& file : {json_, report_})
        if (!file.empty())
            razor::check_writable(file);
    const std::atomic<bool>& interrupted = razor::watch_interrupts();
    const auto describe = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = settings;
        all.insert(all.end(), more.begin(), more.end());
        return describe_machine(machine_.file, all);
    };
    std::optional<Fidelity> found;
    try {
        found = run_at_fidelity(wanted, workers, scene, describe, seed_report_, interrupted);
    } catch (const Stopped&) {
        // said below
    } catch (const razor::Cancelled&) {
        // likewise
    }
    if (!found || interrupted.load()) {
        fmt::print(stderr, "razor-sim: interrupted; nothing written\n");
        return razor::interrupted_exit;
    }
    const Config& config = found->machine.config;
    const std::optional<Calibration> calibration =
        no_calibration_ ? std::nullopt : read_calibration(found->machine);
    Counted counted;
    counted.last_tile = razor::screen_tiles(scene.settings) - 1;
    const bool sampled = found->way().way == Way::sampled;
    const razor::OutputGuard guard;
    if (!json_.empty()) {
        json out{{"program", "razor-sim"},
                 {"version", razor::version()},
                 {"options", {{"workers", workers}, {"share", config.kdtree.share}}},
                 {"scene", razor::to_toml(scene)}};
        json run;
        if (found->closed_form) {
            run = closed_form_json(*found->closed_form, config, workers);
        } else {
            const FrameRun& frame = *found->frame;
            run = sampled ? sampled_json(frame.report, frame.estimate, found->sampling)
                          : json::parse(print_json(frame.report));
            run["renderer"] =
                renderer_json(frame.statistics, counted.of(frame.statistics), frame.duplicates, frame.trees);
            run["renderer"]["screen_tiles"] = counted.tiles();
        }
        json host = run["host"];
        run.erase("host");
        out.update(run);
        out["fidelity"] = fidelity_json(*found);
        out["machine_provenance"] = provenance_json(found->machine);
        if (calibration)
            out["calibration"] = calibration_json(*calibration);
        host["fidelity"] = {{"processor_seconds", found->all_seconds()},
                            {"by_way", found->seconds},
                            {"reference_pilots", found->reference_pilot_seconds}};
        out["host"] = host;
        razor::write_json_file(json_, out);
    }
    std::string text = provenance_text(found->machine) + (calibration ? calibration_text(*calibration) : "") +
                       fidelity_text(*found);
    if (found->closed_form)
        text += closed_form_text(*found->closed_form, config, workers);
    else
        text += frame_text(scene.settings, workers, counted, found->frame->statistics, found->frame->budget,
                           found->frame->report) +
                (sampled ? sampled_text(found->frame->report, found->frame->estimate, found->sampling)
                         : print_text(found->frame->report));
    give(text);
    return 0;
}

} // namespace sim
