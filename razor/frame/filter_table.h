// Where the samples of a pixel lie, and what each counts, so that their mean is the picture filtered: filter
// importance sampling (Ernst, Stamminger & Greiner, Filter Importance Sampling, 2006; pbrt-v4, section 8.8).
// Each sample belongs to one pixel alone; its place is drawn from the filter's absolute value, and what the
// filter is negative at counts negative.
//
// Drawn by a table of the inverse: along each axis bins of (nearly) the same part of the absolute value's
// integral, within which places are even. No bin holds a zero crossing, and a bin's weight is the filter's
// integral over it, so that all integrals from bin to bin are exact, whatever is filtered.
#pragma once

#include "razor/frame/layout.h"
#include "razor/scene/filter.h"

#include <string>
#include <vector>

namespace razor {

struct FilterTable {
    std::vector<FilterBin> bins; // filter_bins of x, from left to right, then of y, from top to bottom
    bool weighted = false;       // some bin counts negative: weights differ
};

/// Throws UserError where the filter's integral is none to divide by, or it has more lobes than can be told
/// apart.
FilterTable tabulate(const Filter& filter);

} // namespace razor
