#include "analysis/metrics/pooling.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace analysis {

PooledErrors pool(const std::vector<float>& errors, const std::vector<bool>& counted) {
    std::vector<float> sorted;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (counted[i]) {
            sorted.push_back(errors[i]);
        }
    }
    if (sorted.empty()) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        return {none, none, none, none, none, none};
    }
    std::sort(sorted.begin(), sorted.end());
    const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
    const auto quantile = [&](double p) {
        double below = 0;
        const auto found = std::find_if(sorted.begin(), sorted.end(),
                                        [&](float error) { return (below += double{error}) > p * sum; });
        return found == sorted.end() ? 0.0 : double{*found};
    };
    return {sum / static_cast<double>(sorted.size()),
            quantile(0.5),
            quantile(0.25),
            quantile(0.75),
            double{sorted.front()},
            double{sorted.back()}};
}

} // namespace analysis
