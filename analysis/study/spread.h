// What several runs of one thing say together.
#pragma once

#include <cstddef>
#include <span>

namespace analysis {

/// Of the values that are finite; all NaN where there are none.
struct Spread {
    std::size_t count = 0;
    double median = 0, least = 0, most = 0; // an even number of values: the mean of the middle two
    double mean = 0;
    double half_width = 0; // of the mean's interval: see half_width()
};
Spread spread_of(std::span<const double> values);

/// Half of the 95 % interval of the mean of independent runs, by Student's t; 0 for less than two, of which
/// nothing is known.
double half_width(std::span<const double> values);
/// The factor on the standard error of a mean that makes it half of the 95 % interval. Without degrees of
/// freedom infinite.
double student_t_975(std::size_t degrees_of_freedom);

} // namespace analysis
