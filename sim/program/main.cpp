// razor-sim: the program of the simulated machine.
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/machine/machine.h"
#include "sim/program/compare_command.h"
#include "sim/program/describe_command.h"
#include "sim/program/dram_table.h"
#include "sim/program/explain_command.h"
#include "sim/program/run_command.h"
#include "sim/program/study_command.h"
#include "sim/program/sweep_command.h"
#include "sim/program/validate_command.h"
#include "traces/error.h"

#include <fmt/format.h>

#include <new>

namespace {

int print_config(const sim::MachineOptions& options) {
    fmt::print("{}", sim::print_machine(sim::describe_machine(options.file, options.settings)));
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Renders on a simulated many-core machine and says where its time and traffic go.",
                 "razor-sim");
    app.set_version_flag("--version", "razor-sim " + std::string(razor::version()));
    app.require_subcommand(1);
    sim::RunCommand run;
    run.add_to(app);
    sim::MachineOptions machine;
    CLI::App& print =
        *app.add_subcommand("print-config", "print a machine's complete, resolved configuration");
    machine.add_to(print);
    sim::DescribeCommand describe;
    describe.add_to(app);
    sim::ExplainCommand explain;
    explain.add_to(app);
    sim::DramTable dram;
    dram.add_to(app);
    sim::ValidateCommand validate;
    validate.add_to(app);
    sim::CompareCommand compare;
    compare.add_to(app);
    sim::StudyCommand study;
    study.add_to(app);
    sim::SweepCommand sweep;
    sweep.add_to(app);
    return razor::run_program(app, argc, argv, [&] {
        try {
            return print.parsed()               ? print_config(machine)
                   : describe.parsed()          ? describe.run()
                   : explain.parsed()           ? explain.run()
                   : validate.parsed()          ? validate.run()
                   : compare.parsed()           ? compare.run()
                   : study.parsed()             ? study.run()
                   : sweep.parsed()             ? sweep.run()
                   : app.got_subcommand("dram") ? dram.run()
                                                : run.run();
        } catch (const sim::ConfigError& e) {
            throw razor::UserError(e.what());
        } catch (const traces::Error& e) {
            throw razor::UserError(e.what());
        } catch (const std::bad_alloc&) {
            throw razor::UserError(
                "out of memory; run fewer workers (--workers), give the machine smaller caches or "
                "stacks (sim.stack_kib), or render a smaller model or picture");
        }
    });
}
