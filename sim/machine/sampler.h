// What of a run is simulated in detail, and what that says of all of it. The run's time is cut into periods
// of equal length; a unit at a place drawn in each is simulated in detail, the rest only warms caches
// (warming.cpp). Before a unit's measured part lies one in which queues fill that counts in no figure. So
// units are a stratified random sample (one of each period; Cochran, Sampling Techniques, 1977, chapters 5
// and 7; SMARTS: Wunderlich et al., ISCA 2003, for one thread). What a unit takes is regressed on what is
// counted everywhere: instructions of builds, other instructions, misses of L1s, lines from below the tile,
// operations on shared words. The rest takes, period by period, what the regression says, times what the
// units around it took of what it said of them. How fast threads pass it is a guess of its own, by the last
// units, the last most, and by core: the fewer threads a core or the chip has left, the faster these are.
#pragma once

#include "sim/core/stalls.h"
#include "sim/machine/regression.h"

#include <cstdint>
#include <random>
#include <vector>

namespace sim {

/// How a run is to be sampled.
struct Sampling {
    double fraction = 0.08; // of the time, simulated in detail: above 0; 1: all, exactly as without sampling
    std::uint32_t seed = 1; // of the places
    cycle unit = 20000;     // measured, cycles
    cycle before = 20000;   // in detail before it, cycles
    std::vector<bool> builds{}; // by phase: whether work counts as building; none do where it is missing
    double confidence = 0.95;   // of the intervals
};

/// A figure of the run and the interval that holds it with the confidence asked for.
struct Estimated {
    double value = 0, low = 0, high = 0;
    /// Half the interval, of the value.
    double error() const { return value > 0 ? (high - low) / (2 * value) : 0; }
};

struct Estimate {
    /// Standard error, relative, of what is counted everywhere: caches are warmed in another order than in a
    /// detailed run. Of runs of four scenes, as are those of cycles, of all that no sample shows (README.md).
    static constexpr double unseen = 0.01;
    /// The same of misses of L1s. Those of one thread are as in a detailed run; where several threads of a
    /// core take turns as nothing takes time, they push more out of each other's: 1 to 3 % more misses than
    /// in whole runs on configs/machines/study.toml, 9 to 12 % on tiny.toml, and there 6, 16 and 33 % with a
    /// core.window of 1, 32 and 200.
    static double unseen_of_l1(std::uint64_t threads_of_core, std::uint64_t window);
    Estimated cycles;
    std::size_t units = 0; // measured
    double detailed = 0;   // cycles simulated in detail
    double spread = 0;     // of what units take beside what the regression says, relative
    SampledCosts costs{};  // of the whole run
    double confidence = 0;

    /// Half the interval of what is counted everywhere, caches being warm in another order; relative.
    double count_error(double standard_error = unseen) const;
};

class Sampler {
public:
    /// `expected`: costs before anything is measured.
    Sampler(const Sampling& wanted, const SampledCosts& expected);

    /// When the mode changes next.
    cycle next() const { return next_; }
    /// The time has come to `t`, at or after next().
    void come_to(cycle t, const WorkByCore& work);
    bool warms() const { return mode_ == Mode::warms; }
    const SampledCosts& costs() const { return costs_; }
    /// Threads' cycles on this core beside what the costs say.
    double pace(std::size_t core) const { return core < paces_.size() ? paces_[core] : 1; }
    bool builds(std::size_t phase) const { return phase < wanted_.builds.size() && wanted_.builds[phase]; }
    /// Of a run that ended at cycle `end`, by the threads' clocks.
    Estimate estimate(cycle end, const WorkByCore& work) const;

private:
    enum class Mode { settles, measures, warms };
    /// What was passed over since the unit before.
    struct Gap {
        std::size_t units; // before it
        cycle length;
        double then; // threads' cycles, as was thought when it was passed
        SampledWork work;
    };
    /// A core's last units: what was spent there, and what the costs of then said.
    struct Core {
        double spent = 0, said = 0;
    };
    cycle draw();
    void learn(const WorkByCore& unit);
    Gap gap(cycle length, const WorkByCore& work) const;
    double ratio(std::size_t first, std::size_t last, const SampledCosts& costs) const;

    Sampling wanted_;
    SampledCosts expected_, costs_;
    Mode mode_ = Mode::settles;
    std::mt19937 random_;
    cycle next_, began_ = 0, rest_ = 0; // rest_: of the period at hand, after its unit
    WorkByCore at_;                     // when the mode began
    std::vector<SampledWork> units_;    // what was done in each
    Moments all_, recent_;              // of them
    std::vector<Core> cores_;
    std::vector<double> paces_; // of these
    std::vector<Gap> gaps_;
};

} // namespace sim
