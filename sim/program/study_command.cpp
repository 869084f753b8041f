#include "sim/program/study_command.h"

#include "analysis/study/error.h"
#include "razor/program/interrupt.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/error.h"
#include "sim/program/study_program.h"
#include "sim/program/study_runs.h"

#include <fmt/format.h>

#include <filesystem>

namespace sim {

void StudyCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "study", "measure runs of many machines against a reference, and what each costs the "
                 "host: error over run time");
    options_.add_to(*command_);
    std::string keys;
    for (const razor::SceneKnob& knob : razor::scene_knobs())
        keys += fmt::format("{}, ", knob.key);
    std::string figures;
    for (const analysis::Figure& figure : machine_study_program().figures)
        figures += fmt::format("  {:<24} {}\n", figure.name, figure.label);
    command_->footer(
        fmt::format("Settings in a study's file: {}, as of razor-sim run (samples: --spp); {}as of razor "
                    "render; and every "
                    "key of machine files (razor-sim print-config).\n\nFigures:\n{}\n"
                    "The form of the file: analysis/study/study_file.h; examples: configs/studies.\n\n{}",
                    fmt::join(run_keys(), ", "), keys, figures, razor::study_exit_codes));
}

int StudyCommand::run() const {
    try {
        razor::StudyProgram program = machine_study_program();
        const analysis::Study study = options_.read(program);
        if (!study.rivals.empty())
            throw razor::UserError(
                fmt::format("{}: machines have no rivals; leave out [[rival]]", study.file));
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
                {machines.references(missing),
                 [&](const analysis::Point& reference) {
                     return machines.measure_reference(reference, store);
                 },
                 true},
                {points, [&](const analysis::Point& point) { return machines.measure(point, store); },
                 false}};
        });
    } catch (const analysis::StudyError& error) {
        throw razor::UserError(error.what());
    }
}

} // namespace sim
