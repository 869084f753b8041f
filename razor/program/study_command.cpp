#include "razor/program/study_command.h"

#include "analysis/study/error.h"
#include "razor/program/interrupt.h"
#include "razor/program/study/image_study.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/program/study/study_pictures.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

namespace razor {

void StudyCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "study",
        "measure pictures of many settings against a reference, and what each costs: error over run time");
    options_.add_to(*command_);
    std::string keys;
    for (const SceneKnob& knob : scene_knobs())
        keys += fmt::format("{}{}", keys.empty() ? "" : ", ", knob.key);
    std::string figures;
    for (const analysis::Figure& figure : image_study_program().figures)
        figures += fmt::format("  {:<24} {}\n", figure.name, figure.label);
    command_->footer(fmt::format(
        "Settings in a study's file: {}, as of razor render (samples: --spp); {}.\n\nFigures:\n{}\n"
        "The form of the file: analysis/study/study_file.h; examples: configs/studies.\n\n{}",
        keys, fmt::join(host_keys(), ", "), figures, study_exit_codes));
}

int StudyCommand::run() const {
    try {
        StudyProgram program = image_study_program();
        const analysis::Study study = options_.read(program);
        const ImageStudy images(study, options_.base(), watch_interrupts());
        const auto points =
            analysis::resolve_points(study, [&](const analysis::Point& point) { return images.body(point); });
        program.changed = [&](const analysis::Point& point) { return images.changed(point); };
        const analysis::Store store(options_.folder());
        return options_.run(program, study, points, store, [&](const std::vector<analysis::Point>& missing) {
            return std::vector<StudyStage>{
                {images.references(missing),
                 [&](const analysis::Point& reference) { return images.make_reference(reference, store); },
                 true},
                {points, [&](const analysis::Point& point) { return images.measure(point, store); }, false}};
        });
    } catch (const analysis::StudyError& error) {
        throw UserError(error.what());
    }
}

} // namespace razor
