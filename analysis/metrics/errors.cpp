#include "analysis/metrics/errors.h"

#include <algorithm>
#include <cmath>

namespace analysis {

Errors errors(const LinearImage& picture, const LinearImage& reference, const std::vector<bool>& counted) {
    constexpr double offset = 0.01; // keeps black references from dividing by zero
    Errors out;
    out.pixels = static_cast<std::size_t>(std::count(counted.begin(), counted.end(), true));
    double squares = 0, relative_squares = 0, fractions = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < counted.size(); ++i) {
            if (counted[i]) {
                const double r = double{reference.planes[c][i]};
                const double difference = double{picture.planes[c][i]} - r;
                const double fraction = std::abs(difference) / (std::max(r, 0.0) + offset);
                squares += difference * difference;
                relative_squares += fraction * fraction;
                fractions += fraction;
            }
        }
    }
    const double terms = 3 * static_cast<double>(out.pixels);
    out.rmse = std::sqrt(squares / terms);
    out.relative_mse = relative_squares / terms;
    out.mape = fractions / terms;
    return out;
}

} // namespace analysis
