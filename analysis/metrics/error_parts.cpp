#include "analysis/metrics/error_parts.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

/// Mean products of all pairs of pictures, over pixels and channels.
class Products {
public:
    Products(std::span<const LinearImage> x, std::span<const LinearImage> y, const std::vector<bool>& counted)
        : count_(x.size() + y.size()), sums_(count_ * count_) {
        std::vector<double> values(count_);
        double terms = 0;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t p = 0; p < counted.size(); ++p) {
                if (!counted[p])
                    continue;
                // Around one value, so that no digits are lost in squares of what all have in common.
                const double middle = y.empty() ? 0 : y[0].planes[c][p];
                for (std::size_t i = 0; i < count_; ++i)
                    values[i] = (i < x.size() ? x[i] : y[i - x.size()]).planes[c][p] - middle;
                for (std::size_t i = 0; i < count_; ++i)
                    for (std::size_t j = 0; j <= i; ++j)
                        sums_[i * count_ + j] += values[i] * values[j];
                terms += 1;
            }
        for (double& sum : sums_)
            sum /= terms;
    }
    double operator()(std::size_t i, std::size_t j) const {
        return sums_[std::max(i, j) * count_ + std::min(i, j)];
    }

private:
    std::size_t count_;
    std::vector<double> sums_;
};

using Numbers = std::vector<std::size_t>; // of pictures

/// The mean product of different ones; of a single one its square.
double mean_of_pairs(const Products& of, const Numbers& some) {
    if (some.size() == 1)
        return of(some[0], some[0]);
    double sum = 0;
    for (const std::size_t i : some)
        for (const std::size_t j : some)
            sum += i == j ? 0 : of(i, j);
    return sum / static_cast<double>(some.size() * (some.size() - 1));
}

double bias_squared(const Products& of, const Numbers& x, const Numbers& y) {
    double out = mean_of_pairs(of, x);
    if (y.empty())
        return out;
    double across = 0;
    for (const std::size_t i : x)
        for (const std::size_t j : y)
            across += of(i, j);
    return out - 2 * across / static_cast<double>(x.size() * y.size()) + mean_of_pairs(of, y);
}

double variance(const Products& of, const Numbers& x) {
    double squares = 0;
    for (const std::size_t i : x)
        squares += of(i, i);
    return squares / static_cast<double>(x.size()) - mean_of_pairs(of, x);
}

/// The squared standard error that leaving out each in turn tells (Tukey's jackknife).
template <class Statistic> double jackknife(const Numbers& all, Statistic statistic) {
    std::vector<double> values;
    double mean = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        Numbers fewer = all;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
        values.push_back(statistic(fewer));
        mean += values.back() / static_cast<double>(all.size());
    }
    double squares = 0;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    return squares * static_cast<double>(all.size() - 1) / static_cast<double>(all.size());
}

double half_width(double squared_error, std::size_t runs) {
    return boost::math::quantile(boost::math::students_t(static_cast<double>(runs - 1)), 0.975) *
           std::sqrt(squared_error);
}

} // namespace

ErrorParts error_parts(std::span<const LinearImage> pictures, std::span<const LinearImage> references,
                       const std::vector<bool>& counted) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    ErrorParts out{{none, none}, {none, none}};
    if (pictures.size() < 2 || std::none_of(counted.begin(), counted.end(), [](bool one) { return one; }))
        return out;
    const Products of(pictures, references, counted);
    Numbers x, y;
    for (std::size_t i = 0; i < pictures.size() + references.size(); ++i)
        (i < pictures.size() ? x : y).push_back(i);
    out.bias_squared.value = bias_squared(of, x, y);
    out.variance.value = variance(of, x);
    if (x.size() < 3)
        return out;
    double squared = jackknife(x, [&](const Numbers& fewer) { return bias_squared(of, fewer, y); });
    std::size_t runs = x.size();
    if (y.size() >= 3) {
        squared += jackknife(y, [&](const Numbers& fewer) { return bias_squared(of, x, fewer); });
        runs = std::min(runs, y.size());
    }
    out.bias_squared.half_width = half_width(squared, runs);
    out.variance.half_width =
        half_width(jackknife(x, [&](const Numbers& fewer) { return variance(of, fewer); }), x.size());
    return out;
}

} // namespace analysis
