#include "razor/program/export_command.h"

#include "razor/api/renderer.h"
#include "razor/native/render.h"
#include "razor/program/interrupt.h"

#include <fmt/format.h>

namespace razor {

void ExportCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "export-mesh", "write the diced mesh of a scene, or of a model without a floor, as an OBJ file");
    scene_.add_to(*command_, "scene");
    command_->add_option("-o,--output", output_, "the mesh")->type_name("FILE.obj")->required();
    command_->add_option("--isa", isa_, "instruction set: auto, plain, sse4, avx2 or avx512")
        ->type_name("NAME");
}

int ExportCommand::run() const {
    RenderOptions options{.isa = isa_};
    options.cancel = &watch_interrupts();
    const api::Renderer renderer(api::Scene(scene_.describe_alone()), options, false);
    try {
        const OutputGuard guard;
        const api::MeshFigures written = renderer.write_mesh(output_);
        fmt::print("{}: {} points, {} faces\n", output_, written.points, written.faces);
        return 0;
    } catch (const Cancelled&) {
        fmt::print(stderr, "razor: interrupted; nothing written\n");
        return interrupted_exit;
    }
}

} // namespace razor
