#include "sim/program/option_values.h"

#include "razor/scene/error.h"

#include <fmt/format.h>

#include <string>

namespace sim {
namespace {

void check_option(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const bool folder = type.starts_with("FOLDER");
    if (!folder && !type.starts_with("FILE"))
        return;
    for (const std::string& value : option.results())
        if (value == "-")
            throw razor::UserError(fmt::format("{}: - stands for no {} here; give its name",
                                               option.get_name(), folder ? "folder" : "file"));
}

} // namespace

void refuse_dashes(const CLI::App& app) {
    for (const CLI::App* const command : app.get_subcommands())
        for (const CLI::Option* const option : command->get_options())
            check_option(*option);
}

} // namespace sim
