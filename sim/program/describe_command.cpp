#include "sim/program/describe_command.h"

#include "analysis/plots/raster.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/scene/error.h"
#include "sim/config/machine_file.h"
#include "sim/machine/describe.h"
#include "sim/program/provenance.h"
#include "sim/reports/chip_drawing.h"

#include <fmt/format.h>

#include <filesystem>

namespace sim {

void DescribeCommand::add_to(CLI::App& app) {
    command_ =
        app.add_subcommand("describe", "print a chip, or draw it: its parts, and what they can do at most");
    machine_.add_to(*command_);
    command_
        ->add_option(
            "-o,--output", output_,
            "draw the chip: tiles, cores, caches, network and memory channels, each with its name where "
            "a pointer rests (.svg), or as pixels (.png)")
        ->type_name("FILE");
}

int DescribeCommand::run() const {
    const std::filesystem::path output = output_;
    const bool pixels = razor::is_png(output);
    if (!output_.empty() && !pixels && output.extension() != ".svg")
        throw razor::UserError(fmt::format("{}: is no drawing by its name; end it in .svg or .png", output_));
    const MachineDescription machine = noted_machine(machine_.file, machine_.settings);
    if (output_.empty()) {
        fmt::print("{}\n{}", provenance_text(machine), chip_text(machine.config));
        return 0;
    }
    razor::check_writable(output);
    const analysis::Svg drawing =
        draw_chip(machine.config, std::filesystem::path(machine.name).stem().string());
    razor::write_text_file(output,
                           pixels ? analysis::png_bytes(analysis::rasterised(drawing, 1.5)) : drawing.file());
    return 0;
}

} // namespace sim
