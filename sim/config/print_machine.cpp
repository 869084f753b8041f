// A machine as a file that says everything.
#include "sim/config/machine_file.h"
#include "sim/config/parameters.h"

#include <fmt/core.h>

#include <filesystem>

namespace sim {
namespace {

/// The file's whole name: what is printed may be put into any folder.
std::string calibration_line(const std::string& file) {
    std::string quoted;
    for (const char c : std::filesystem::absolute(file).lexically_normal().string()) {
        if (c == '"' || c == '\\')
            quoted += '\\';
        quoted += c;
    }
    return fmt::format("# counts beside those of real builds; analysis/calibration writes them\n"
                       "calibration = \"{}\"\n",
                       quoted);
}

} // namespace

std::string print_machine(const MachineDescription& machine) {
    std::string out, section;
    if (!machine.origins.empty())
        out = fmt::format("# {}, with everything that it inherits, defaults and overrides.\n", machine.name);
    if (!machine.calibration.empty())
        out += calibration_line(machine.calibration);
    std::size_t i = 0;
    for (const Parameter& p : parameters()) {
        if (!applies(p, machine.config)) {
            ++i;
            continue;
        }
        const std::size_t dot = p.key.find('.');
        if (p.key.substr(0, dot) != section) {
            section = p.key.substr(0, dot);
            out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", section);
        }
        out += fmt::format("# {}; {}", p.meaning, print_bounds(p));
        std::string line = fmt::format("{} = {}", p.key.substr(dot + 1), print_value(p, machine.config));
        if (i < machine.origins.size()) {
            const Origin& origin = machine.origins[i];
            out += fmt::format("; from: {}", origin.place());
            if (!origin.comment.empty())
                line = fmt::format("{:<27}# {}", line + " ", origin.comment);
        }
        out += "\n" + line + "\n";
        ++i;
    }
    return out;
}

std::string print_machine(const Config& config) {
    return print_machine(MachineDescription{config, "", {}, ""});
}

} // namespace sim
