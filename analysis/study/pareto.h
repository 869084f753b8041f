// Which points are worth having where two figures are to be small: the Pareto front.
#pragma once

#include "analysis/study/spread.h"

#include <span>
#include <vector>

namespace analysis {

struct Trade {
    Spread x, y; // both better the smaller
};

enum class Standing {
    front,     // no other point is at least as good in both figures and better in one, by their medians
    tied,      // one is, but by less than the runs of either differ: another day it may be the other way
    dominated, // one is, beyond the spread of the runs
    unknown    // a figure is missing
};

/// Of each point. A figure is better beyond the spread where its greatest value is below the other's least.
/// Of points with equal medians all or none are on the front.
std::vector<Standing> pareto(std::span<const Trade> points);

} // namespace analysis
