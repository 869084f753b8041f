// How the motion in a cage's file is played.
#pragma once

#include "razor/scene/animation/track.h"

#include <optional>
#include <string>
#include <utility>

namespace razor {

struct Playback {
    std::optional<std::pair<int, int>> frames; // first and last, of a sequence of files or in one file
    double frame_rate = 24;                    // of those, a second
    Timing timing;                             // between those; of a clip its cycle alone
    std::string clip;                          // of a glTF file; empty: the first
    std::string clip_file;                     // absolute path of that file; empty: the cage's own
    // The motion's own seconds are start + speed times the scene's, or stand still.
    double start = 0, speed = 1;
    std::optional<double> moment;

    double seconds(double scene_seconds) const { return moment.value_or(start + speed * scene_seconds); }
    bool operator==(const Playback&) const = default;
};

} // namespace razor
