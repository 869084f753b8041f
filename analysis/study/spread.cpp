#include "analysis/study/spread.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace analysis {
namespace {

std::vector<double> finite_of(std::span<const double> values) {
    std::vector<double> out;
    std::copy_if(values.begin(), values.end(), std::back_inserter(out),
                 [](double x) { return std::isfinite(x); });
    return out;
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

double student_t_975(std::size_t degrees_of_freedom) {
    if (degrees_of_freedom == 0)
        return std::numeric_limits<double>::infinity();
    return boost::math::quantile(boost::math::students_t(static_cast<double>(degrees_of_freedom)), 0.975);
}

double half_width(std::span<const double> all) {
    const std::vector<double> values = finite_of(all);
    if (values.size() < 2)
        return 0;
    const double mean = mean_of(values);
    double squares = 0;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    const auto n = static_cast<double>(values.size());
    return student_t_975(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
}

Spread spread_of(std::span<const double> all) {
    std::vector<double> values = finite_of(all);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (values.empty())
        return {0, none, none, none, none, none};
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {n,
            (values[(n - 1) / 2] + values[n / 2]) / 2,
            values.front(),
            values.back(),
            mean_of(values),
            half_width(values)};
}

} // namespace analysis
