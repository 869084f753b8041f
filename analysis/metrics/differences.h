// Two pictures, bit for bit and channel by channel.
#pragma once

#include "analysis/images/image_file.h"

#include <cstddef>
#include <string>
#include <vector>

namespace analysis {

/// How one channel of picture `a` differs from the same channel of `b`. Pixels are numbered by rows from the
/// top.
struct ChannelDifference {
    std::string name;
    std::size_t pixels = 0;
    std::size_t differing = 0, first = 0; // pixels whose bits differ, and the first of them
    // Over the pixels that are numbers in both (neither NaN nor infinite):
    std::size_t left_out = 0; // the others
    double largest = 0;       // the largest absolute difference
    std::size_t largest_at = 0;
    double a = 0, b = 0; // the values there
    double rmse = 0;     // root of the mean squared difference; 0 where no pixel is left
    /// Of those left out: pixels that are not equal (one is not a number, or the infinities differ in sign).
    std::size_t not_numbers_differing = 0;
};

struct Differences {
    bool same_size = true;
    std::vector<ChannelDifference> channels;            // those of the same name and type in both
    std::vector<std::string> only_in_a, only_in_b;      // names of channels
    std::vector<std::string> stored_as_different_types; // names of channels
    std::size_t pixels_differing = 0;                   // pixels with different bits in any of `channels`

    /// Sizes, names and types of channels, and every bit agree.
    bool identical() const;
};

/// NaNs are equal where their bits are; +0 and -0 differ. Pictures of different sizes are not looked into.
Differences differences(const ImageFile& a, const ImageFile& b);

} // namespace analysis
