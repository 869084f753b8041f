#include "traces/program/study_command.h"

#include "analysis/study/error.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"
#include "traces/program/study_runs.h"

#include <fmt/format.h>

namespace traces {

void StudyCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "study", "measure miss ratios from samples of a trace against exact stack distances, and what each "
                 "costs the host: error over run time");
    options_.add_to(*command_);
    std::string figures;
    for (const analysis::Figure& figure : trace_study_program().figures)
        figures += fmt::format("  {:<24} {}\n", figure.name, figure.label);
    command_->footer(fmt::format("Settings in a study's file:\n{}\nFigures:\n{}\n"
                                 "The form of the file: analysis/study/study_file.h; an example: "
                                 "configs/studies/trace-sampling.toml.",
                                 trace_settings_text(), figures));
}

int StudyCommand::run() const {
    try {
        razor::StudyProgram program = trace_study_program();
        const analysis::Study study = options_.read(program);
        if (!study.rivals.empty())
            throw Error(fmt::format("{}: traces have no rivals; leave out [[rival]]", study.file));
        if (!study.reference.empty())
            throw Error(fmt::format(
                "{}: traces are compared with exact stack distances; leave out [reference]", study.file));
        const TraceStudy traces(study, options_.base(), razor::watch_interrupts());
        const auto points =
            analysis::resolve_points(study, [&](const analysis::Point& point) { return traces.body(point); });
        program.changed = [&](const analysis::Point& point) { return traces.changed(point); };
        const analysis::Store store(options_.folder());
        return options_.run(program, study, points, store, [&](const std::vector<analysis::Point>& missing) {
            return std::vector<razor::StudyStage>{
                {traces.references(missing),
                 [&](const analysis::Point& reference) { return traces.measure_reference(reference); }, true},
                {points, [&](const analysis::Point& point) { return traces.measure(point, store); }, false}};
        });
    } catch (const analysis::StudyError& error) {
        throw Error(error.what());
    } catch (const razor::UserError& error) {
        throw Error(error.what());
    } catch (const analysis::Stopped&) { // before anything was measured
        throw Interrupted();
    }
}

} // namespace traces
