// What a replay counted, for programs, and beside the report of a run.
#pragma once

#include "sim/replay/replay.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sim {

/// A JSON object with the names of a run's report (razor-sim run --json) for what both have: the machine,
/// counters of caches, network, coherence and memory, traffic; and `replay`: how the references came.
std::string print_replay(const ReplayResult& result);

/// A figure of both.
struct Comparison {
    std::string part, counter; // "l2", "misses"
    std::uint64_t replayed = 0, run = 0;
    /// Of what the run has; infinite where it has none.
    double error() const;
};
/// All that a run's report (its text) and a replay count both, in the report's order, of all caches of a
/// level together and of each. `name`: the file's. Throws traces::Error where that is no such report, or is
/// of other caches.
std::vector<Comparison> compare_with_run(const ReplayResult& result, const std::string& report,
                                         const std::string& name);

} // namespace sim
