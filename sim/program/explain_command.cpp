#include "sim/program/explain_command.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "sim/machine/explain.h"
#include "sim/program/sharing_report.h"

#include <fmt/format.h>

#include <vector>

namespace sim {
namespace {

/// Of machines' reports, and of what only runs of the program have.
std::vector<Explanation> all_explanations() {
    std::vector<Explanation> out = explanations();
    out.insert(out.end(), sharing_explanations().begin(), sharing_explanations().end());
    return out;
}

std::string_view nearest_name(const std::vector<Explanation>& all, std::string_view words) {
    std::vector<std::string_view> names;
    for (const Explanation& e : all)
        names.push_back(std::string_view(e.path).substr(e.path.rfind('.') + 1));
    return razor::nearest(words, names);
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
            text += fmt::format("{}{}: {}\n", e.path, e.unit.empty() ? "" : " (" + e.unit + ")", e.meaning);
    if (text.empty())
        throw razor::UserError(fmt::format("no figure of a report is called '{}'; did you mean '{}'?", words_,
                                           nearest_name(all, words_)));
    fmt::print("{}", text);
    return 0;
}

} // namespace sim
