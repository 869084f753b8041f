// Command-line values with clear messages, and how every program ends on a mistake.
#pragma once

#include "razor/scene/ranges.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace razor {

/// "0.1.0".
std::string_view version();

/// `text` as a number in the range. `option` names it in messages: "--spp". Throws UserError.
int parse_whole(std::string_view option, std::string_view text, Range range);
double parse_number(std::string_view option, std::string_view text, Range range);
/// "640x480" as width and height, each in the range.
std::pair<int, int> parse_size(std::string_view option, std::string_view text, Range range);
/// "640,480,16,16" as four numbers in the range.
std::array<int, 4> parse_four(std::string_view option, std::string_view text, Range range);
/// "3..17" (or with another word between) as first and last, each in the range, in order.
std::pair<int, int> parse_span(std::string_view option, std::string_view text, Range range,
                               std::string_view between = "..");
/// "0:40" as two numbers of which the first is less.
std::pair<double, double> parse_bounds(std::string_view option, std::string_view text);
/// "256MiB" as bytes: a whole number, or one with a fraction, and KiB, MiB or GiB; at least 64 KiB, at most
/// 1024 GiB. Throws UserError.
std::uint64_t parse_bytes(std::string_view option, std::string_view text);
/// "10s" as seconds, from a millisecond to 1000 hours: a number and ms, s, min or h. Throws UserError.
double parse_seconds(std::string_view option, std::string_view text);
/// The index of `text` in `words`.
std::size_t parse_choice(std::string_view option, std::string_view text,
                         std::span<const std::string_view> words);

/// Workers that share a kd-tree: "worker" is 1, "chip" 0 (all of them), or a number.
int parse_share(std::string_view text);

/// Parses the command line, then runs `action`, whose result is the exit code. --help and --version end with
/// 0. No file is called "-". A mistake of the user prints one line "PROGRAM: ..." to the error stream and
/// ends with 2, anything unforeseen likewise with 1.
int run_program(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& action);

} // namespace razor
