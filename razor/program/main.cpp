// razor: the native renderer's program.
#include "razor/program/arguments.h"
#include "razor/program/check_command.h"
#include "razor/program/compare_command.h"
#include "razor/program/export_command.h"
#include "razor/program/info_command.h"
#include "razor/program/render_command.h"
#include "razor/program/study_command.h"

int main(int argc, char** argv) {
    CLI::App app("Renders Catmull-Clark and bilinear-patch scenes, examines and lists them, compares "
                 "pictures, exports "
                 "meshes and measures errors against run time.",
                 "razor");
    app.set_version_flag("--version", "razor " + std::string(razor::version()));
    app.require_subcommand(1);
    razor::RenderCommand render;
    render.add_to(app);
    razor::CompareCommand compare;
    compare.add_to(app);
    razor::ExportCommand dice;
    dice.add_to(app);
    razor::CheckCommand check;
    check.add_to(app);
    razor::InfoCommand info;
    info.add_to(app);
    razor::StudyCommand study;
    study.add_to(app);
    return razor::run_program(app, argc, argv, [&] {
        if (check.given())
            return check.run();
        if (study.given())
            return study.run();
        if (info.given())
            return info.run();
        if (compare.given())
            return compare.run();
        return dice.given() ? dice.run() : render.run();
    });
}
