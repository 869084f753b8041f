// An error map as a few numbers, those that FLIP's own tool prints.
#pragma once

#include <vector>

namespace analysis {

/// Weighted quantiles: the errors weighted by themselves, so that the many pixels without error count little
/// (Andersson et al. 2020). The quantile at p is the first error, in rising order, at which the
/// sum of the errors so far exceeds p of the whole sum; 0 where all errors are 0.
struct PooledErrors {
    double mean = 0;
    double weighted_median = 0, weighted_first_quartile = 0, weighted_third_quartile = 0;
    double minimum = 0, maximum = 0;
};

/// Pools the pixels that are `counted`; all NaN where none is.
PooledErrors pool(const std::vector<float>& errors, const std::vector<bool>& counted);

} // namespace analysis
