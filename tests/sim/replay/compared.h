// A trace replayed, and what of its counts differs from those of the run that it is of.
#pragma once

#include "sim/replay/replay_report.h"
#include "tests/sim/replay/workload.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sim::test {

inline ReplayResult replay(const std::string& trace, const Config& config) {
    traces::Reader reader(traces::memory_source(trace, "trace"));
    Replay replay(config, reader.description(), {});
    traces::Block block;
    while (reader.next(block))
        replay.add(block);
    EXPECT_TRUE(reader.complete());
    return replay.finish(reader.description());
}

/// The first counts that differ, in words.
inline std::string differences(const std::vector<Comparison>& all) {
    std::string out;
    for (const Comparison& c : all)
        if (c.replayed != c.run && out.size() < 1500)
            out += c.part + " " + c.counter + ": " + std::to_string(c.replayed) + ", the run had " +
                   std::to_string(c.run) + "\n";
    return out;
}

} // namespace sim::test
