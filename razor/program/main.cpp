// razor: the native renderer's program.
#include "razor/program/arguments.h"
#include "razor/program/compare_command.h"
#include "razor/program/render_command.h"

int main(int argc, char** argv) {
    CLI::App app("Renders Catmull-Clark and bilinear-patch scenes, and compares pictures.", "razor");
    app.set_version_flag("--version", "razor " + std::string(razor::version()));
    app.require_subcommand(1);
    razor::RenderCommand render;
    render.add_to(app);
    razor::CompareCommand compare;
    compare.add_to(app);
    return razor::run_program(app, argc, argv,
                              [&] { return compare.given() ? compare.run() : render.run(); });
}
