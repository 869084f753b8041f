// Least and greatest values of settings, the same in scene files and on the command line.
#pragma once

namespace razor {

struct Range {
    double least = 0, most = 0; // both allowed
};

inline constexpr Range size_range{1, 32768};          // pixels, width and height
inline constexpr Range samples_range{1, 65536};       // a pixel
inline constexpr Range shadow_samples_range{1, 4096}; // a hit, to the light or the sky
inline constexpr Range edge_pixels_range{0.01, 1e4};

} // namespace razor
