#include "sim/machine/sampler.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sim {
namespace {

double said(const SampledWork& work, const SampledCosts& costs) {
    return std::inner_product(costs.begin(), costs.end(), work.of.begin(), 0.0);
}

SampledWork since(const SampledWork& now, const SampledWork& before) {
    SampledWork w;
    for (std::size_t i = 0; i < w.of.size(); ++i)
        w.of[i] = now.of[i] - before.of[i];
    w.spent = now.spent - before.spent;
    return w;
}

/// Of a unit beside the costs expected: how much the least squares trust these.
constexpr double trust = 0.5;

/// Standard error, relative, of cycles that no sample shows: threads met otherwise than in a detailed run,
/// and ended otherwise.
constexpr double unseen_of_cycles = 0.015;

} // namespace

Sampler::Sampler(const Sampling& wanted, const SampledCosts& expected)
    : wanted_(wanted), expected_(expected), costs_(expected), random_(wanted.seed),
      next_(wanted.fraction < 1 ? wanted.before : ~cycle{0}) {}

/// How long the next gap is: the rest of a period and what lies before the unit of the next.
cycle Sampler::draw() {
    const auto detailed = static_cast<double>(wanted_.unit + wanted_.before);
    const auto free = static_cast<cycle>(detailed / wanted_.fraction - detailed);
    const cycle place = std::uniform_int_distribution<cycle>(0, free)(random_);
    return std::exchange(rest_, free - place) + place;
}

void Sampler::come_to(cycle t, const SampledWork& work) {
    if (mode_ == Mode::settles) {
        mode_ = Mode::measures;
        next_ = t + wanted_.unit;
    } else if (mode_ == Mode::measures) {
        units_.push_back(since(work, at_));
        fit();
        mode_ = Mode::warms;
        next_ = t + draw();
    } else {
        gaps_.push_back({units_.size(), t - began_, costs_, since(work, at_)});
        mode_ = Mode::settles;
        next_ = t + wanted_.before;
    }
    began_ = t;
    at_ = work;
}

/// Least squares in which no cost is negative, by descent along each of them, as multiples of what was
/// expected, scaled to fit on the whole: of these, `trust` units say that they are 1.
void Sampler::fit() {
    constexpr std::size_t n = SampledWork::kinds;
    double spent = 0, expected = 0;
    for (const SampledWork& u : units_) {
        spent += u.spent;
        expected += said(u, expected_);
    }
    if (spent <= 0 || expected <= 0)
        return;
    const double scale = spent / expected, mean = spent / static_cast<double>(units_.size());
    std::array<std::array<double, n>, n> a{};
    std::array<double, n> b{}, x{};
    for (std::size_t j = 0; j < n; ++j)
        a[j][j] = b[j] = trust;
    for (const SampledWork& u : units_) {
        for (std::size_t j = 0; j < n; ++j)
            x[j] = u.of[j] * expected_[j] * scale / mean;
        for (std::size_t i = 0; i < n; ++i) {
            b[i] += x[i] * u.spent / mean;
            for (std::size_t j = 0; j < n; ++j)
                a[i][j] += x[i] * x[j];
        }
    }
    std::array<double, n> multiple;
    multiple.fill(1);
    for (int round = 0; round < 100; ++round)
        for (std::size_t i = 0; i < n; ++i) {
            double rest = b[i];
            for (std::size_t j = 0; j < n; ++j)
                rest -= j == i ? 0 : a[i][j] * multiple[j];
            multiple[i] = std::max(0.0, rest / a[i][i]);
        }
    for (std::size_t j = 0; j < n; ++j)
        costs_[j] = expected_[j] * scale * multiple[j];
}

/// What units took beside what the costs say, from number `first` on, before `last`.
double Sampler::ratio(std::size_t first, std::size_t last) const {
    double spent = 0, all = 0;
    for (std::size_t i = first; i < last; ++i) {
        spent += units_[i].spent;
        all += said(units_[i], costs_);
    }
    return all > 0 ? spent / all : 1;
}

double Estimate::count_error() const {
    const boost::math::normal normal;
    return unseen * boost::math::quantile(normal, 0.5 + confidence / 2);
}

Estimate Sampler::estimate(cycle end, const SampledWork& work) const {
    Estimate e;
    e.units = units_.size();
    e.costs = costs_;
    e.confidence = wanted_.confidence;
    std::vector<Gap> gaps = gaps_;
    if (mode_ == Mode::warms)
        gaps.push_back({units_.size(), end - began_, costs_, since(work, at_)});
    double passed = 0, estimated = 0;
    for (const Gap& g : gaps) {
        const std::size_t first = g.units > 2 ? g.units - 2 : 0, last = std::min(units_.size(), g.units + 2);
        const double then = said(g.work, g.costs), now = said(g.work, costs_) * ratio(first, last);
        passed += static_cast<double>(g.length);
        estimated += static_cast<double>(g.length) * (then > 0 ? now / then : 1);
    }
    e.detailed = static_cast<double>(end) - passed;
    e.cycles.value = e.cycles.low = e.cycles.high = e.detailed + estimated;
    if (gaps.empty())
        return e;
    const std::size_t n = units_.size();
    if (n < 2) {
        e.spread = 1;
    } else {
        double squares = 0;
        for (std::size_t i = 0; i + 1 < n; ++i) {
            const double d = ratio(i + 1, i + 2) - ratio(i, i + 1);
            squares += d * d;
        }
        e.spread = std::sqrt(squares / (2 * static_cast<double>(n - 1)));
    }
    const boost::math::students_t t(static_cast<double>(std::max<std::size_t>(n, 2) - 1));
    const double quantile = boost::math::quantile(t, 0.5 + wanted_.confidence / 2);
    const double drawn = e.spread / std::sqrt(static_cast<double>(std::max<std::size_t>(n, 1)));
    const double error = estimated * quantile * std::hypot(drawn, unseen_of_cycles);
    e.cycles.low = std::max(e.detailed, e.cycles.value - error);
    e.cycles.high = e.cycles.value + error;
    return e;
}

} // namespace sim
