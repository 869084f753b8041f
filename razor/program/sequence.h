// The frames of a sequence.
#pragma once

#include <string_view>

namespace razor {

struct FrameRange {
    int first = 0, last = 0;

    int count() const { return last - first + 1; }
};

/// "3:17", or "3" alone. Throws UserError.
FrameRange parse_frames(std::string_view text);

/// Throws UserError unless each frame has a name of its own (razor/scene/numbered_name.h).
void check_numbered(std::string_view option, std::string_view name, const FrameRange& frames);

} // namespace razor
