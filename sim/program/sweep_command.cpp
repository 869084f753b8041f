#include "sim/program/sweep_command.h"

#include "analysis/study/error.h"
#include "razor/program/interrupt.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "sim/program/study_program.h"
#include "sim/program/study_runs.h"

#include <fmt/format.h>

#include <filesystem>

namespace sim {

void SweepCommand::add_to(CLI::App& app) {
    command_ =
        app.add_subcommand("sweep", "run the designs of a study side by side, and say which are worth having "
                                    "and what each setting does");
    options_.add_to(*command_, razor::StudyKind::sweep);
    std::string keys, figures;
    for (const razor::SceneKnob& knob : razor::scene_knobs())
        keys += fmt::format("{}, ", knob.key);
    for (const analysis::Figure& figure : sweep_program().figures)
        figures += fmt::format("  {:<24} {}\n", figure.name, figure.label);
    command_->footer(fmt::format(
        "A study is a file of kind = \"sweep\": [settings] of all designs, lists under [knobs] of which each "
        "combination is a design, where = [\"core.lanes * chip.threads <= 64\"] for what must hold of their "
        "numbers (what the study does "
        "not set is as the machine's file says), [[exclude]] for those to leave out, seeds = N for N runs of "
        "each that "
        "differ in "
        "noise (sim.jitter) alone. Three and more are needed to rank designs: those whose runs overlap are "
        "not told "
        "apart.\n\n"
        "Settings: {}, as of razor-sim run; {}as of razor render (samples: --spp); and every key of machine "
        "files "
        "(razor-sim print-config), such as l2.size_bytes = [\"256 KiB\", \"1 MiB\"].\n\nFigures:\n{}\n"
        "What is done stays: an interrupted sweep goes on by the same command, and several may work in one "
        "folder, "
        "on one host or many. A design that fails has a result that says why, and stops no other.\n"
        "The form of the file: analysis/study/study_file.h; examples: configs/studies; on clusters: "
        "analysis/sweep/Snakefile.\n\n{}",
        fmt::join(run_keys(), ", "), keys, figures, razor::study_exit_codes));
}

int SweepCommand::run() const {
    try {
        razor::StudyProgram program = sweep_program();
        const analysis::Study study = options_.read(program);
        if (!study.rivals.empty() || !study.reference.empty())
            throw razor::UserError(
                fmt::format("{}: designs are compared with each other; leave out {}, or use "
                            "razor-sim study for errors against a reference",
                            study.file, study.rivals.empty() ? "[reference]" : "[[rival]]"));
        const MachineStudy machines(study, options_.base(),
                                    std::filesystem::canonical("/proc/self/exe").string(),
                                    razor::watch_interrupts());
        const auto points = analysis::resolve_points(
            study, [&](const analysis::Point& point) { return machines.body(point); });
        program.changed = [&](const analysis::Point& point) { return machines.changed(point); };
        const analysis::Store store(options_.folder());
        return options_.run(program, study, points, store, [&](const std::vector<analysis::Point>& missing) {
            return std::vector<razor::StudyStage>{
                {machines.tile_seeds(missing),
                 [&](const analysis::Point& seed) { return machines.measure_tile_seed(seed, store); }, true},
                {points, [&](const analysis::Point& point) { return machines.measure(point, store); },
                 false}};
        });
    } catch (const analysis::StudyError& error) {
        throw razor::UserError(error.what());
    }
}

} // namespace sim
