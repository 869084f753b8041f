#include "sim/program/explain_command.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "sim/machine/explain.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

std::string_view nearest_name(std::string_view words) {
    std::vector<std::string_view> names;
    for (const Explanation& e : explanations())
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
    const std::vector<const Explanation*> found = find_explanations(words_);
    if (!words_.empty() && found.empty())
        throw razor::UserError(fmt::format("no figure of a report is called '{}'; did you mean '{}'?", words_,
                                           nearest_name(words_)));
    std::string text;
    for (const Explanation& e : explanations())
        if (words_.empty() || std::find(found.begin(), found.end(), &e) != found.end())
            text += fmt::format("{}{}: {}\n", e.path, e.unit.empty() ? "" : " (" + e.unit + ")", e.meaning);
    fmt::print("{}", text);
    return 0;
}

} // namespace sim
