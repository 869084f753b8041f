// Two pictures, bit for bit.
#pragma once

#include "analysis/images/image_file.h"

#include <string>

namespace analysis {

struct Comparison {
    bool identical = true;
    std::string report; // one line a difference; "identical: W x H, n planes" where there is none
};

/// Compares sizes, channel names, kinds and every bit. NaNs are equal where their bits are; +0 and -0 differ.
Comparison compare(const ImageFile& a, const ImageFile& b);

} // namespace analysis
