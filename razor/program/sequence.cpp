#include "razor/program/sequence.h"

#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/numbered_name.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <filesystem>

namespace razor {
FrameRange parse_frames(std::string_view text) {
    if (text.find(':') == std::string_view::npos) {
        const int frame = parse_whole("--frames", text, frame_range);
        return {frame, frame};
    }
    const auto [first, last] = parse_span("--frames", text, frame_range, ":");
    return {first, last};
}

void check_numbered(std::string_view option, std::string_view name, const FrameRange& frames) {
    if (has_number(numbered(name, 0))) {
        throw UserError(fmt::format("{} {}: has more than one place for a number; keep one", option,
                                    printable(name, 1000)));
    }
    if (frames.count() == 1 || has_number(name)) {
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
