// razor-trace: what is in a trace, the same in another format, and what caches would make of it.
#include "traces/convert.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"
#include "traces/io/sink.h"
#include "traces/program/analyses.h"
#include "traces/program/overlay_command.h"
#ifdef RAZOR_HAS_SIMULATED
#include "traces/program/replay_command.h"
#endif
#include "traces/program/study_command.h"
#include "traces/summary.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

namespace {

constexpr int mistake_exit = 2, failure_exit = 1, interrupted_exit = 130;

std::string formats_text() {
    std::string out = "formats:\n";
    for (const traces::Format& f : traces::formats())
        out += fmt::format("  {:<10} {} ({})\n", f.name, f.meaning, f.suffixes);
    return out + "A format shows in a name's ending, before .gz, .xz or .zst; '-' is a standard stream.";
}

struct Info {
    std::string file, from;
    bool json = false;

    int run() const {
        auto source = traces::open_source(file);
        const traces::Format& format = traces::format_of_input(from, file, *source);
        traces::Summary::File about{source->name(), std::string(format.name), "", 0};
        const auto input = format.read(std::move(source));
        traces::Summary summary;
        for (traces::Block block; input->next(block);) {
            traces::check_interrupts();
            summary.add(block);
        }
        about.note = input->note();
        std::error_code none;
        if (std::filesystem::is_regular_file(file, none))
            about.bytes = std::filesystem::file_size(file, none);
        fmt::print("{}", json ? summary.json(input->description(), about)
                              : summary.text(input->description(), about));
        return 0;
    }
};

struct Convert {
    std::string in, out, from, to, coding;

    std::unique_ptr<traces::Output> output(const traces::Format& target) const {
        if (coding.empty())
            return target.write(traces::open_sink(out));
        if (&target != traces::formats().data())
            throw traces::Error(fmt::format("--coding is of rzt; {} has none, leave it out", target.name));
        if (coding != "columns" && coding != "predicted")
            throw traces::Error(fmt::format("--coding {}: give columns or predicted", coding));
        return traces::write_own(traces::open_sink(out),
                                 coding == "columns" ? traces::Coding::columns : traces::Coding::predicted);
    }
    int run() const {
        auto source = traces::open_source(in);
        const traces::Format& source_format = traces::format_of_input(from, in, *source);
        const traces::Format& target = traces::format_of_output(to, out);
        const auto input = source_format.read(std::move(source));
        const auto to_file = output(target); // maybe `in`, whose name it gets at the end
        traces::Conversion conversion(*input, *to_file, target.holds);
        while (conversion.step())
            traces::check_interrupts();
        to_file->finish();
        if (!input->note().empty())
            fmt::print(stderr, "razor-trace: {}\n", input->note());
        if (const std::string lost = conversion.lost(); !lost.empty())
            fmt::print(stderr, "razor-trace: {} does not hold all of {}: {}\n", target.name,
                       source_format.name, lost);
        return 0;
    }
};

/// An empty value is no way to leave an option out.
void refuse_empty(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options())
        for (const std::string& value : option->results())
            if (value.empty())
                throw traces::Error(
                    fmt::format("{}: is empty; give a value, or leave it out", option->get_name()));
}

/// What standard output still holds goes nowhere: who should read it may not.
[[noreturn]] void end_early() {
    fmt::print(stderr, "razor-trace: interrupted; nothing written\n");
    std::_Exit(interrupted_exit);
}

/// One line.
int complain(std::string text, int code) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    fmt::print(stderr, "razor-trace: {}\n", text);
    return code;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Says what is in a trace of memory references, what caches make of it, and converts it.",
                 "razor-trace");
    app.set_version_flag("--version", "razor-trace " RAZOR_VERSION);
    app.require_subcommand(1);
    app.footer(formats_text());
    Info info;
    CLI::App& informing = *app.add_subcommand("info", "say what is in a trace, in counts");
    informing.add_option("TRACE", info.file, "a trace of any format, or -")->required();
    informing.add_option("--from", info.from, "its format; without it, as it begins or is named")
        ->type_name("FORMAT");
    informing.add_flag("--json", info.json, "for programs, with the configuration of what was traced");
    Convert convert;
    CLI::App& converting = *app.add_subcommand("convert", "write a trace in another format");
    converting.add_option("IN", convert.in, "a trace of any format, or -")->required();
    converting.add_option("OUT", convert.out, "the file to write, whole or not at all, or -")->required();
    converting.add_option("--from", convert.from, "the format of IN; without it, as it begins or is named")
        ->type_name("FORMAT");
    converting.add_option("--to", convert.to, "the format of OUT; without it, as it is named")
        ->type_name("FORMAT");
    converting
        .add_option("--coding", convert.coding,
                    "how rzt has its blocks: columns, which are read soon, or predicted, which are small; "
                    "without it, columns of cores and L1s, else predicted")
        ->type_name("CODING");
    const std::vector<std::unique_ptr<traces::AnalysisCommand>> analyses = traces::analyses();
    for (const auto& analysis : analyses)
        analysis->add_to(app);
    traces::OverlayCommand overlay;
    overlay.add_to(app);
    traces::StudyCommand study;
    study.add_to(app);
#ifdef RAZOR_HAS_SIMULATED // the machine is part of this build
    traces::ReplayCommand replay;
    replay.add_to(app);
#endif
    traces::listen_for_interrupts();
    try {
        app.parse(argc, argv);
        for (const CLI::App* command : app.get_subcommands())
            refuse_empty(*command);
        int done = 0;
        if (informing.parsed())
            done = info.run();
        if (converting.parsed())
            done = convert.run();
        for (const auto& analysis : analyses)
            if (analysis->parsed())
                analysis->run();
        if (overlay.parsed())
            overlay.run();
        if (study.parsed())
            done = study.run();
#ifdef RAZOR_HAS_SIMULATED
        if (replay.parsed())
            replay.run();
#endif
        traces::finish_standard_output();
        return done;
    } catch (const traces::Interrupted&) {
        end_early();
    } catch (const CLI::Success& help) {
        return app.exit(help, std::cout, std::cerr);
    } catch (const CLI::ParseError& e) {
        if (argc > 1 && *argv[1] != '-' && app.get_subcommands().empty())
            return complain(fmt::format("{}: there is no such command; see razor-trace --help", argv[1]),
                            mistake_exit);
        return complain(fmt::format("{}; see razor-trace --help", e.what()), mistake_exit);
    } catch (const traces::Error& e) {
        return complain(e.what(), mistake_exit);
    } catch (const std::bad_alloc&) {
        return complain("out of memory", failure_exit);
    } catch (const std::system_error& e) {
        if (traces::interrupted())
            end_early();
        return std::ferror(stdout) != 0
                   ? complain(fmt::format("standard output: cannot be written ({}); check who reads it",
                                          e.code().message()),
                              mistake_exit)
                   : complain(fmt::format("internal error: {}", e.what()), failure_exit);
    } catch (const std::exception& e) {
        return complain(fmt::format("internal error: {}", e.what()), failure_exit);
    }
}
