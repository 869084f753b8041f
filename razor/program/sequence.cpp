#include "razor/program/sequence.h"

#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <filesystem>

namespace razor {
namespace {

/// Where a name has %d or %04d: its begin and length, and how many digits at least; length 0: nowhere.
struct Place {
    std::size_t begin = 0, length = 0;
    int digits = 1;
};

Place find_number(std::string_view name) {
    for (std::size_t begin = name.find('%'); begin != std::string_view::npos;
         begin = name.find('%', begin + 1)) {
        std::size_t end = begin + 1;
        int digits = 1;
        if (end + 1 < name.size() && name[end] == '0' && name[end + 1] >= '1' && name[end + 1] <= '9') {
            digits = name[end + 1] - '0';
            end += 2;
        }
        if (end < name.size() && name[end] == 'd') {
            return {begin, end + 1 - begin, digits};
        }
    }
    return {};
}

} // namespace

FrameRange parse_frames(std::string_view text) {
    if (text.find(':') == std::string_view::npos) {
        const int frame = parse_whole("--frames", text, frame_range);
        return {frame, frame};
    }
    const auto [first, last] = parse_span("--frames", text, frame_range, ":");
    return {first, last};
}

std::string numbered(std::string_view name, int frame) {
    const Place at = find_number(name);
    if (at.length == 0) {
        return std::string(name);
    }
    return fmt::format("{}{:0{}}{}", name.substr(0, at.begin), frame, at.digits,
                       name.substr(at.begin + at.length));
}

void check_numbered(std::string_view option, std::string_view name, const FrameRange& frames) {
    if (frames.count() == 1 || find_number(name).length != 0) {
        return;
    }
    const std::filesystem::path path(name);
    throw UserError(fmt::format(
        "{} {}: one name for {} frames; write their number into it: {}", option, printable(name, 1000),
        frames.count(),
        printable(
            (path.parent_path() / (path.stem().string() + "_%04d" + path.extension().string())).string(),
            1000)));
}

} // namespace razor
