#include "razor/program/arguments.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <system_error>

namespace razor {
namespace {

/// All option names of the subcommand that was given, else of the program.
std::vector<std::string> option_names(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    std::vector<std::string> names;
    for (const CLI::Option* const option : (chosen.empty() ? app : *chosen.front()).get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

/// With the word that was meant, where one is near; else where all are listed.
std::string unknown(std::string_view kind, const std::string& typed, std::span<const std::string_view> known,
                    std::string_view help) {
    const std::string_view near = meant(typed, known);
    return near.empty() ? fmt::format("unknown {} {}; see {}", kind, printable(typed), help)
                        : fmt::format("unknown {} {}; did you mean {}?", kind, printable(typed), near);
}

/// CLI11's complaint as one line, with the nearest option for one that does not exist.
std::string mend(const CLI::App& app, const CLI::ParseError& error) {
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    message = printable(message.substr(0, message.find_last_not_of(". ") + 1), 300);
    const std::vector<std::string> extras = app.remaining(true);
    const auto chosen = app.get_subcommands();
    const std::string help =
        fmt::format("{}{} --help", app.get_name(), chosen.empty() ? "" : " " + chosen.front()->get_name());
    if (!extras.empty() && extras.front().starts_with("--")) {
        const std::vector<std::string> names = option_names(app);
        const std::vector<std::string_view> known(names.begin(), names.end());
        const std::string typed = extras.front().substr(0, extras.front().find('='));
        return unknown("option", typed, known, help);
    }
    if (chosen.empty() && !extras.empty()) {
        std::vector<std::string> names;
        for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
            names.push_back(command->get_name());
        }
        const std::vector<std::string_view> known(names.begin(), names.end());
        if (!known.empty()) {
            return unknown("command", extras.front(), known, help);
        }
    }
    return fmt::format("{}; see {}", message, help);
}

/// An unset variable of a shell is an empty value: what would be done then is not what was meant.
void refuse_empty_values(const CLI::App& app) {
    for (const CLI::Option* const option : app.get_options()) {
        const std::vector<std::string>& values = option->results();
        if (std::find(values.begin(), values.end(), "") != values.end())
            throw UserError(fmt::format("{} '' is empty; give {}{}", option->get_name(),
                                        option->get_type_name(),
                                        option->get_required() ? "" : ", or leave it out"));
    }
    for (const CLI::App* const command : app.get_subcommands())
        refuse_empty_values(*command);
}

/// What the program has said is written, or UserError.
void finish_output() {
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout)
        throw UserError(
            fmt::format("standard output: cannot be written ({}); check who reads it", std::strerror(errno)));
}

/// Parses, and says what --help and --version ask for; whether there is anything to do.
bool parse(CLI::App& app, int argc, const char* const* argv) {
    for (int i = 1; i < argc; ++i) { // the next argument would be the value
        const std::string_view argument = argv[i];
        if (argument.starts_with("--") && argument.ends_with('='))
            throw UserError(
                fmt::format("{} is empty; give it a value, or leave it out", printable(argument)));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        app.exit(help, std::cout, std::cerr);
        finish_output();
        return false;
    }
    refuse_empty_values(app);
    return true;
}

int complain(const CLI::App& app, std::string_view message, int code) {
    fmt::print(stderr, "{}: {}\n", app.get_name(), message);
    return code;
}

/// Throws UserError where an option of the subcommand that was given has - in the place of a file or a
/// folder.
void refuse_dashes(const CLI::App& app) {
    for (const CLI::App* const command : app.get_subcommands())
        for (const CLI::Option* const option : command->get_options()) {
            const std::string type = option->get_type_name();
            const bool folder = type.starts_with("FOLDER");
            if (!folder && !type.starts_with("FILE"))
                continue;
            for (const std::string& value : option->results())
                if (value == "-")
                    throw UserError(fmt::format("{}: - stands for no {} here; give its name",
                                                option->get_name(), folder ? "folder" : "file"));
        }
}

} // namespace

std::string_view version() {
    return RAZOR_VERSION;
}

int parse_whole(std::string_view option, std::string_view text, Range range) {
    long long value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool right = error == std::errc{} && stop == text.data() + text.size();
    if (!right || static_cast<double>(value) < range.least || static_cast<double>(value) > range.most) {
        throw UserError(fmt::format("{} '{}' is not possible; give a whole number from {} to {}", option,
                                    printable(text), range.least, range.most));
    }
    return static_cast<int>(value);
}

double parse_number(std::string_view option, std::string_view text, Range range) {
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool right = error == std::errc{} && stop == text.data() + text.size();
    if (!right || !(value >= range.least && value <= range.most)) {
        throw UserError(fmt::format("{} '{}' is not possible; give a number from {} to {}", option,
                                    printable(text), range.least, range.most));
    }
    return value;
}

std::pair<int, int> parse_size(std::string_view option, std::string_view text, Range range) {
    const std::size_t cross = text.find('x');
    if (cross == std::string_view::npos) {
        throw UserError(fmt::format("{} '{}' is not possible; give WIDTHxHEIGHT, for example 640x480", option,
                                    printable(text)));
    }
    return {parse_whole(fmt::format("the width of {}", option), text.substr(0, cross), range),
            parse_whole(fmt::format("the height of {}", option), text.substr(cross + 1), range)};
}

std::array<int, 4> parse_four(std::string_view option, std::string_view text, Range range) {
    std::array<int, 4> result{};
    std::string_view rest = text;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (i == 3)) {
            throw UserError(fmt::format("{} '{}' is not possible; give four whole numbers with commas "
                                        "between them, for example 512,256,64,64",
                                        option, printable(text)));
        }
        result[i] = parse_whole(option, rest.substr(0, comma), range);
        rest = i == 3 ? "" : rest.substr(comma + 1);
    }
    return result;
}

std::pair<int, int> parse_span(std::string_view option, std::string_view text, Range range,
                               std::string_view between) {
    const std::size_t at = text.find(between);
    if (at == std::string_view::npos) {
        throw UserError(fmt::format("{0} '{1}' is not possible; give FIRST{2}LAST, for example 0{2}9", option,
                                    printable(text), between));
    }
    const std::pair<int, int> span{
        parse_whole(fmt::format("the first of {}", option), text.substr(0, at), range),
        parse_whole(fmt::format("the last of {}", option), text.substr(at + between.size()), range)};
    if (span.first > span.second)
        throw UserError(
            fmt::format("{} '{}' ends before it begins; give FIRST{}LAST", option, printable(text), between));
    return span;
}

std::pair<double, double> parse_bounds(std::string_view option, std::string_view text) {
    constexpr Range values{-1e30, 1e30};
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos)
        throw UserError(
            fmt::format("{} '{}' is not possible; give LOW:HIGH, for example 0:40", option, printable(text)));
    const std::pair bounds(
        parse_number(fmt::format("the low end of {}", option), text.substr(0, colon), values),
        parse_number(fmt::format("the high end of {}", option), text.substr(colon + 1), values));
    if (!(bounds.first < bounds.second))
        throw UserError(fmt::format("{} '{}' ends before it begins; give LOW:HIGH", option, printable(text)));
    return bounds;
}

std::uint64_t parse_bytes(std::string_view option, std::string_view text) {
    constexpr std::pair<std::string_view, int> units[] = {{"KiB", 10}, {"MiB", 20}, {"GiB", 30}};
    for (const auto& [unit, log2] : units) {
        double value = 0;
        const char* const end = text.data() + text.size() - std::min(unit.size(), text.size());
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (!text.ends_with(unit) || error != std::errc{} || stop != end)
            continue;
        const double bytes = std::ldexp(value, log2);
        if (bytes >= 65536 && bytes <= std::ldexp(1.0, 40))
            return static_cast<std::uint64_t>(bytes);
    }
    throw UserError(
        fmt::format("{} '{}' is not possible; give a size from 64KiB to 1024GiB, for example 256MiB", option,
                    printable(text)));
}

double parse_seconds(std::string_view option, std::string_view text) {
    constexpr std::pair<std::string_view, double> units[] = {
        {"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}};
    for (const auto& [unit, factor] : units) {
        double value = 0;
        const char* const end = text.data() + text.size() - std::min(unit.size(), text.size());
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (text.ends_with(unit) && error == std::errc{} && stop == end && value * factor >= 1e-3 &&
            value * factor <= 3.6e6)
            return value * factor;
    }
    throw UserError(fmt::format("{} '{}' is not possible; give a time from 1ms to 1000h, for example 10s",
                                option, printable(text)));
}

std::size_t parse_choice(std::string_view option, std::string_view text,
                         std::span<const std::string_view> words) {
    const auto found = std::find(words.begin(), words.end(), text);
    if (found == words.end()) {
        throw UserError(fmt::format("{} '{}' is unknown; give one of: {}", option, printable(text),
                                    fmt::join(words, ", ")));
    }
    return static_cast<std::size_t>(found - words.begin());
}

int parse_share(std::string_view text) {
    if (text == "worker") {
        return 1;
    }
    if (text == "chip") {
        return 0;
    }
    if (text == "core" || text == "tile") {
        throw UserError(fmt::format("--share '{0}' needs a machine that says what a {0} is (razor-sim); give "
                                    "worker, chip or a number of workers a tree",
                                    text));
    }
    if (text.find_first_not_of("0123456789") != std::string_view::npos) {
        throw UserError(
            fmt::format("--share '{}' is unknown; give worker, chip or a number of workers a tree", text));
    }
    return parse_whole("--share", text, Range{1, 1 << 20});
}

int run_program(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& action) {
    try {
        if (!parse(app, argc, argv))
            return 0;
        refuse_dashes(app);
        const int done = action();
        finish_output();
        return done;
    } catch (const CLI::ParseError& error) {
        return complain(app, mend(app, error), 2);
    } catch (const UserError& error) {
        return complain(app, error.what(), 2);
    } catch (const std::bad_alloc&) {
        return complain(app, "out of memory; render a smaller model or picture", 1);
    } catch (const std::system_error& error) {
        return std::ferror(stdout) != 0
                   ? complain(app, fmt::format("standard output: {}; check who reads it", error.what()), 2)
                   : complain(app, fmt::format("internal error: {}", printable(error.what(), 300)), 1);
    } catch (const std::exception& error) {
        return complain(app, fmt::format("internal error: {}", printable(error.what(), 300)), 1);
    }
}

} // namespace razor
