// What work of each kind takes, by least squares over units that were measured, each with a weight of its
// own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sim {

/// What has been done, of all threads.
struct SampledWork {
    enum Kind : std::size_t { builds, others, misses, lines, words };
    static constexpr std::size_t kinds = 5;
    std::array<double, kinds> of{};
    double spent = 0; // threads' cycles simulated in detail, but for sleep until a word changes, and idleness
};
/// What has been done on each core; `lines`, of which nobody counts by core, are of all.
struct WorkByCore {
    std::vector<SampledWork> cores;
    double lines = 0;

    WorkByCore since(const WorkByCore& before) const;
    /// With each core's share of the lines, as that of misses.
    std::vector<SampledWork> shared() const;
    SampledWork all() const;
};
/// Threads' cycles that one of each takes.
using SampledCosts = std::array<double, SampledWork::kinds>;

/// What the costs say of the work, in threads' cycles.
double said(const SampledWork& work, const SampledCosts& costs);

/// The sums over units that least squares need.
class Moments {
public:
    void add(const SampledWork& unit);
    /// All units so far count so much less.
    void fade(double by);
    /// Least squares in which no cost is negative, by descent along each of them, as multiples of `expected`,
    /// scaled to fit on the whole: of these, `trust` units say that they are 1. `expected` itself where
    /// nothing was measured.
    SampledCosts fit(const SampledCosts& expected, double trust) const;

private:
    static constexpr std::size_t n = SampledWork::kinds;
    std::array<std::array<double, n>, n> squares_{}; // work of one kind times that of another
    std::array<double, n> products_{}, work_{};      // work times what was spent; work
    double spent_ = 0, units_ = 0;
};

} // namespace sim
