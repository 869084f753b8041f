#include "sim/estimate/fidelity.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sim {
namespace {

/// Samples that have been run.
struct Sampled {
    OwnError first;      // of the smallest
    double fraction = 0; // ... 0: none yet
};

/// Of a sample of another fraction, by the smallest one's. What no sample shows goes with what is left out.
RelativeError scaled(const Sampled& known, double fraction) {
    const double cycles = known.first.error.cycles, drawn = std::min(known.first.drawn, cycles);
    const double unseen = std::sqrt(cycles * cycles - drawn * drawn);
    return {std::hypot(drawn * std::sqrt(known.fraction / fraction),
                       unseen * (1 - fraction) / (1 - known.fraction)),
            known.first.error.dram_bytes};
}

} // namespace

const char* name_of(Rung::State state) {
    switch (state) {
    case Rung::State::not_needed:
        return "not needed";
    case Rung::State::impossible:
        return "not possible";
    case Rung::State::passed_over:
        return "passed over";
    case Rung::State::too_wide:
        return "too wide";
    default:
        return "chosen";
    }
}

double pilot_error(const std::vector<double>& differences) {
    const auto n = static_cast<double>(differences.size());
    if (differences.size() < 2)
        return std::numeric_limits<double>::infinity();
    const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
    double squares = 0;
    for (const double d : differences)
        squares += (d - mean) * (d - mean);
    const boost::math::students_t t(n - 1);
    return std::abs(mean) + boost::math::quantile(t, 0.975) * std::sqrt(squares / (n - 1) / n);
}

std::size_t choose_fidelity(double wanted, std::vector<Rung>& rungs, const Trials& trials) {
    Sampled known;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        Rung& rung = rungs[i];
        if (!rung.impossible.empty()) {
            rung.state = Rung::State::impossible;
            continue;
        }
        const bool exact = rung.way == Way::reference;
        if (!exact && wanted > 0) {
            if (rung.way == Way::fast) {
                rung.predicted = trials.pilot(i);
            } else if (rung.way == Way::sampled && known.fraction > 0) {
                rung.predicted = scaled(known, rung.fraction);
                rung.source = "interval of the smallest sample";
            }
        }
        if (!exact && (wanted <= 0 || (rung.predicted && rung.predicted->worst() > wanted))) {
            rung.state = Rung::State::passed_over;
            continue;
        }
        const OwnError own = trials.run(i);
        rung.error = own.error;
        if (exact || own.error.worst() <= wanted) {
            rung.state = Rung::State::chosen;
            return i;
        }
        rung.state = Rung::State::too_wide;
        if (rung.way == Way::sampled && known.fraction == 0) {
            known.first = own;
            known.fraction = rung.fraction;
        }
    }
    return rungs.size() - 1;
}

} // namespace sim
