#include "sim/machine/regression.h"

#include <algorithm>
#include <numeric>

namespace sim {

WorkByCore WorkByCore::since(const WorkByCore& before) const {
    WorkByCore w = *this;
    w.lines -= before.lines;
    for (std::size_t c = 0; c < before.cores.size(); ++c) {
        for (std::size_t i = 0; i < SampledWork::kinds; ++i)
            w.cores[c].of[i] -= before.cores[c].of[i];
        w.cores[c].spent -= before.cores[c].spent;
    }
    return w;
}

SampledWork WorkByCore::all() const {
    SampledWork w;
    for (const SampledWork& core : cores) {
        for (std::size_t i = 0; i < SampledWork::kinds; ++i)
            w.of[i] += core.of[i];
        w.spent += core.spent;
    }
    w.of[SampledWork::lines] = lines;
    return w;
}

std::vector<SampledWork> WorkByCore::shared() const {
    std::vector<SampledWork> w = cores;
    const double misses = all().of[SampledWork::misses];
    for (SampledWork& core : w)
        core.of[SampledWork::lines] = misses > 0 ? lines * core.of[SampledWork::misses] / misses : 0;
    return w;
}

double said(const SampledWork& work, const SampledCosts& costs) {
    return std::inner_product(costs.begin(), costs.end(), work.of.begin(), 0.0);
}

void Moments::add(const SampledWork& unit) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
            squares_[i][j] += unit.of[i] * unit.of[j];
        products_[i] += unit.of[i] * unit.spent;
        work_[i] += unit.of[i];
    }
    spent_ += unit.spent;
    units_ += 1;
}

void Moments::fade(double by) {
    for (std::size_t i = 0; i < n; ++i) {
        for (double& square : squares_[i])
            square *= by;
        products_[i] *= by;
        work_[i] *= by;
    }
    spent_ *= by;
    units_ *= by;
}

SampledCosts Moments::fit(const SampledCosts& expected, double trust) const {
    const double all = std::inner_product(expected.begin(), expected.end(), work_.begin(), 0.0);
    if (spent_ <= 0 || all <= 0)
        return expected;
    const double scale = spent_ / all, mean = spent_ / units_;
    SampledCosts unit{}; // of what units spend in the mean, what work of one kind takes by what is expected
    for (std::size_t i = 0; i < n; ++i)
        unit[i] = expected[i] * scale / mean;
    std::array<std::array<double, n>, n> a{};
    std::array<double, n> b{}, multiple;
    multiple.fill(1);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
            a[i][j] = squares_[i][j] * unit[i] * unit[j];
        a[i][i] += trust;
        b[i] = trust + products_[i] * unit[i] / mean;
    }
    for (int round = 0; round < 100; ++round)
        for (std::size_t i = 0; i < n; ++i) {
            double rest = b[i];
            for (std::size_t j = 0; j < n; ++j)
                rest -= j == i ? 0 : a[i][j] * multiple[j];
            multiple[i] = std::max(0.0, rest / a[i][i]);
        }
    SampledCosts costs;
    for (std::size_t i = 0; i < n; ++i)
        costs[i] = expected[i] * scale * multiple[i];
    return costs;
}

} // namespace sim
