#include "sim/program/explain_command.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"
#include "sim/machine/explain.h"
#include "sim/program/frame_report.h"
#include "sim/program/sharing_report.h"
#include "sim/program/study_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace sim {
namespace {

/// Of reports of estimates, and of runs that choose how they are simulated.
const Explanation other_explanations[] = {
    {"estimate.how", "", "sampled, or in closed form"},
    {"estimate.fraction", "", "of the time that was to be simulated in detail"},
    {"estimate.seed", "", "where samples are taken"},
    {"estimate.units", "", "samples"},
    {"estimate.unit_cycles", "cycles", "of a sample"},
    {"estimate.detailed_cycles", "cycles", "that were simulated in detail"},
    {"estimate.confidence", "", "with which true values lie within the bounds"},
    {"estimate.spread", "", "by which samples differ from what their work says, relative"},
    {"estimate.figures.*.value", "", "an estimated figure"},
    {"estimate.figures.*.low", "", "it is at least this, by the confidence"},
    {"estimate.figures.*.high", "", "it is at most this, by the confidence"},
    {"estimate.stations[].station", "", "in closed form: a part of the chip that threads queue for"},
    {"estimate.stations[].utilisation", "", "of the time, that it is busy"},
    {"estimate.limiter", "", "in closed form: what the chip's throughput is limited by"},
    {"estimate.threads_at_work", "", "in closed form: on average, while screen tiles are rendered"},
    {"estimate.threads_waiting", "", "likewise, waiting for what others build"},
    {"estimate.once_cycles", "cycles", "in closed form: of work that is done once, by all workers together"},
    {"estimate.built_instructions", "", "in closed form: of the instructions, those of builds"},
    {"host.model_seconds", "s", "of the host, for the closed form alone"},
    {"host.count_seconds", "s", "of the host, to count the frame's work natively"},
    {"host.seed_processor_seconds", "s", "of processor time, that the simulated tile took when it was made"},
    {"host.seed_made", "", "whether the simulated tile was made in this run"},
    {"fidelity.how", "", "who chose the way of simulating"},
    {"fidelity.wanted_error", "", "the relative error asked for"},
    {"fidelity.chosen", "", "the way that was taken"},
    {"fidelity.error.cycles", "", "relative error of the cycles of the way taken"},
    {"fidelity.error.dram_bytes", "", "relative error of its bytes from and to DRAM"},
    {"fidelity.confidence", "", "with which errors are no greater"},
    {"fidelity.ways[].way", "", "a way of simulating, the cheapest first"},
    {"fidelity.ways[].state", "", "whether it was taken, and if not, why"},
    {"fidelity.ways[].predicted_error.*", "", "its relative error, from runs of parts of the frame"},
    {"fidelity.ways[].source", "", "what its error is predicted from"},
    {"fidelity.ways[].own_error.*", "", "its relative error by its own run"},
    {"fidelity.ways[].settings", "", "options of razor-sim run that take it"}};

/// Of machines' reports, and of what only runs of the program have.
std::vector<Explanation> all_explanations() {
    std::vector<Explanation> out = explanations();
    out.insert(out.end(), sharing_explanations().begin(), sharing_explanations().end());
    out.insert(out.end(), frame_explanations().begin(), frame_explanations().end());
    out.insert(out.end(), std::begin(other_explanations), std::end(other_explanations));
    for (const analysis::Figure& figure : machine_study_program().figures)
        if (std::none_of(out.begin(), out.end(), [&](const Explanation& e) { return e.path == figure.name; }))
            out.push_back({figure.name, "", figure.label + " (in tables of study and sweep)"});
    return out;
}

std::string line_of(const Explanation& e) {
    return fmt::format("{}{}: {}\n", e.path, e.unit.empty() ? "" : " (" + e.unit + ")", e.meaning);
}

std::string_view meant_name(const std::vector<Explanation>& all, std::string_view words) {
    std::vector<std::string_view> names;
    for (const Explanation& e : all)
        for (std::string_view path = e.path; !path.empty();) {
            names.push_back(path); // with and without the names before
            path.remove_prefix(std::min(path.find('.'), path.size() - 1) + 1);
        }
    return razor::meant(words, names);
}

std::string no_figure(const std::vector<Explanation>& all, const std::string& words) {
    const std::string_view near = meant_name(all, words);
    return fmt::format("no figure of a report is called '{}'; ", razor::printable(words)) +
           (near.empty() ? "razor-sim explain alone says which there are"
                         : fmt::format("did you mean '{}'?", near));
}

} // namespace

void ExplainCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand("explain", "say what figures of a JSON report mean");
    command_
        ->add_option("name", words_,
                     "a figure, such as mispredicts, l1.hits or memory; without it, all of them in order")
        ->type_name("NAME");
}

int ExplainCommand::run() const {
    const std::vector<Explanation> all = all_explanations();
    std::string text;
    for (const Explanation& e : all)
        if (words_.empty() || is_named(e, words_))
            text += line_of(e);
    for (const Explanation& e : text.empty() ? all : std::vector<Explanation>{})
        if (is_named_within(e, words_))
            text += line_of(e);
    if (text.empty())
        throw razor::UserError(no_figure(all, words_));
    fmt::print("{}", text);
    return 0;
}

} // namespace sim
