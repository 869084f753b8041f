// razor-sim run --estimate closed-form: its options, and what it writes.
#include "razor/frame/frame.h"
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"
#include "sim/program/closed_form_run.h"
#include "sim/program/provenance.h"
#include "sim/program/run_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace sim {

using json = nlohmann::ordered_json;

bool RunCommand::in_closed_form() const {
    return estimate_ == "closed-form";
}

void RunCommand::check_closed_form(const Config& config) const {
    if (const std::string why = not_in_closed_form(config); !why.empty())
        throw razor::UserError(fmt::format(
            "--estimate closed-form: this machine is not computed: {}; give sample:FRACTION", why));
    const std::pair<const char*, bool> others[] = {
        {"-o", !outputs_.empty()},           {"--intervals", !intervals_.empty()},
        {"--frames", !frames_.empty()},      {"--tiles", !tiles_.empty()},
        {"--memory", !memory_.empty()},      {"--host-threads", !host_threads_.empty()},
        {"--trace", trace_.wanted()},        {"--tiles-in-rows", tiles_in_rows_},
        {"--estimate-seed", !seed_.empty()}, {"--costs and --false-colour", costs_.given()},
        {"--sharing", sharing_.wanted()},
    };
    for (const auto& [option, given] : others)
        if (given)
            throw razor::UserError(fmt::format(
                "--estimate closed-form computes one whole frame and renders none; leave out {}", option));
}

int RunCommand::run_closed_form(const MachineDescription& machine, int workers,
                                const razor::SceneDescription& scene) const {
    razor::check_apart({json_, report_, seed_report_});
    for (const std::string& file : {json_, report_, seed_report_})
        if (!file.empty())
            razor::check_writable(file);
    const std::atomic<bool>& interrupted = razor::watch_interrupts();
    std::optional<ClosedForm> result;
    try {
        result = compute_closed_form(machine.config, workers, scene, seed_report_, quiet_, interrupted);
    } catch (const Stopped&) {
        // said below
    } catch (const razor::Cancelled&) {
        // likewise
    }
    if (!result || interrupted.load()) {
        fmt::print(stderr, "razor-sim: interrupted; nothing written\n");
        return razor::interrupted_exit;
    }
    const razor::OutputGuard guard;
    if (!json_.empty()) {
        json out{{"program", "razor-sim"},
                 {"version", razor::version()},
                 {"options", {{"workers", workers}, {"share", machine.config.kdtree.share}}},
                 {"scene", razor::to_toml(scene)}};
        out.update(closed_form_json(*result, machine.config, workers));
        out["machine_provenance"] = provenance_json(machine);
        razor::write_json_file(json_, out);
    }
    const std::string text = provenance_text(machine) + closed_form_text(*result, machine.config, workers);
    give(text);
    return 0;
}

} // namespace sim
