// Bars from 1 to a ratio on a logarithmic axis, with the range of what the ratio is the median of.
#pragma once

#include "analysis/plots/svg.h"

#include <string>
#include <vector>

namespace analysis {

struct RatioChart {
    struct Bar {
        std::string name;                     // at the left
        double median = 1, low = 1, high = 1; // above 0
        bool faint = false;                   // it may as well be 1
    };
    std::string label; // of the axis
    std::vector<Bar> bars;

    /// 860 pixels wide, as high as it has bars.
    Svg drawing() const;
};

} // namespace analysis
