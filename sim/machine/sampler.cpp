#include "sim/machine/sampler.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {
namespace {

/// How much least squares trust the costs expected: as so many units.
constexpr double trust = 0.5;

/// Of what is thought of the next gap: how much a unit counts of the one after it, and as how many units the
/// costs of the whole run are trusted; and the like of a core's own pace.
constexpr double fading = 1 - 1 / 16.0, trust_in_all = 4;
constexpr double core_fading = 1 - 1 / 8.0, trust_in_one = 2;

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

void Sampler::come_to(cycle t, const WorkByCore& work) {
    if (mode_ == Mode::settles) {
        mode_ = Mode::measures;
        next_ = t + wanted_.unit;
    } else if (mode_ == Mode::measures) {
        learn(work.since(at_));
        mode_ = Mode::warms;
        next_ = t + draw();
    } else {
        gaps_.push_back(gap(t - began_, work));
        mode_ = Mode::settles;
        next_ = t + wanted_.before;
    }
    began_ = t;
    at_ = work;
}

/// From a unit.
void Sampler::learn(const WorkByCore& unit) {
    units_.push_back(unit.all());
    all_.add(units_.back());
    recent_.fade(fading);
    recent_.add(units_.back());
    costs_ = recent_.fit(all_.fit(expected_, trust), trust_in_all);
    const std::vector<SampledWork> cores = unit.shared();
    cores_.resize(cores.size());
    paces_.resize(cores.size());
    const double some = trust_in_one * units_.back().spent / static_cast<double>(cores.size());
    for (std::size_t c = 0; c < cores.size(); ++c) {
        cores_[c].spent = cores_[c].spent * core_fading + cores[c].spent;
        cores_[c].said = cores_[c].said * core_fading + said(cores[c], costs_);
        paces_[c] = some > 0 ? (cores_[c].spent + some) / (cores_[c].said + some) : 1;
    }
}

Sampler::Gap Sampler::gap(cycle length, const WorkByCore& work) const {
    const WorkByCore passed = work.since(at_);
    const std::vector<SampledWork> cores = passed.shared();
    double then = 0;
    for (std::size_t c = 0; c < cores.size(); ++c)
        then += pace(c) * said(cores[c], costs_);
    return {units_.size(), length, then, passed.all()};
}

/// What units took beside what the costs say, from number `first` on, before `last`.
double Sampler::ratio(std::size_t first, std::size_t last, const SampledCosts& costs) const {
    double spent = 0, all = 0;
    for (std::size_t i = first; i < last; ++i) {
        spent += units_[i].spent;
        all += said(units_[i], costs);
    }
    return all > 0 ? spent / all : 1;
}

double Estimate::unseen_of_l1(std::uint64_t threads_of_core, std::uint64_t window) {
    if (threads_of_core == 1)
        return unseen;
    constexpr double most_of_window_8 = 0.07;
    return most_of_window_8 * std::max(1.0, std::log2(static_cast<double>(window)) / 3);
}

double Estimate::count_error(double standard_error) const {
    const boost::math::normal normal;
    return standard_error * boost::math::quantile(normal, 0.5 + confidence / 2);
}

Estimate Sampler::estimate(cycle end, const WorkByCore& work) const {
    Estimate e;
    e.units = units_.size();
    e.costs = all_.fit(expected_, trust);
    e.confidence = wanted_.confidence;
    std::vector<Gap> gaps = gaps_;
    if (mode_ == Mode::warms)
        gaps.push_back(gap(end - began_, work));
    double passed = 0, estimated = 0;
    for (const Gap& g : gaps) {
        const std::size_t first = g.units > 2 ? g.units - 2 : 0, last = std::min(units_.size(), g.units + 2);
        const double now = said(g.work, e.costs) * ratio(first, last, e.costs);
        passed += static_cast<double>(g.length);
        estimated += static_cast<double>(g.length) * (g.then > 0 ? now / g.then : 1);
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
            const double d = ratio(i + 1, i + 2, e.costs) - ratio(i, i + 1, e.costs);
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
