// What a setting does to a figure: the ratio between its extreme values where all other settings are the
// same.
#pragma once

#include "analysis/study/settings.h"
#include "analysis/study/spread.h"

#include <span>
#include <string>
#include <vector>

namespace analysis {

/// A point: what it is and what was measured; a count of 0 where nothing was.
struct Response {
    const Settings* settings;
    Spread figure;
};

struct Sensitivity {
    std::string knob;
    Value from, to; // of numbers the least and the greatest, of words the first and the last that is met
    Spread ratio;   // of medians, at `to` and at `from`, over all pairs of points that differ in nothing else
    std::size_t sure = 0; // of these, pairs whose runs do not overlap (surely_below())
};

/// Of each knob of which there is a pair.
std::vector<Sensitivity> sensitivities(std::span<const Response> points,
                                       const std::vector<std::string>& knobs);

} // namespace analysis
