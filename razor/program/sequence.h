// The frames of a sequence, and the names of what is written of each.
#pragma once

#include <string>
#include <string_view>

namespace razor {

struct FrameRange {
    int first = 0, last = 0;

    int count() const { return last - first + 1; }
};

/// "3:17", or "3" alone. Throws UserError.
FrameRange parse_frames(std::string_view text);

/// A name with the number of the frame in place of %d, or of %04d with zeros before it, where it has one.
std::string numbered(std::string_view name, int frame);
/// Throws UserError unless each frame has a name of its own.
void check_numbered(std::string_view option, std::string_view name, const FrameRange& frames);

} // namespace razor
