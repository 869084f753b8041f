// Of random machines, too, a trace that is replayed on the machine that made it gives all that the run
// counted, to the last one.
#include "tests/sim/random_machine.h"
#include "tests/sim/replay/compared.h"

#include <cstdlib>

namespace sim::test {
namespace {

/// RAZOR_RANDOM_MACHINES: how many (60).
int machines_wanted() {
    const char* text = std::getenv("RAZOR_RANDOM_MACHINES");
    return text != nullptr ? std::atoi(text) : 60;
}

void expect_equal(const Config& config, const std::string& level) {
    SCOPED_TRACE(level);
    TraceSettings settings;
    settings.level = level;
    const Recorded run = record(config, 50, settings);
    const ReplayResult result = replay(run.trace, config);
    EXPECT_TRUE(result.ended);
    EXPECT_EQ(result.waits, 0U);
    EXPECT_EQ(differences(compare_with_run(result, print_json(run.report), "run")), "");
}

TEST(RandomReplay, CountsWhatTheRunCounted) {
    std::mt19937 random(2026);
    const int wanted = machines_wanted();
    ASSERT_GT(wanted, 0);
    for (int trial = 0; trial < wanted; ++trial) {
        const Config c = random_machine(random);
        SCOPED_TRACE(std::to_string(trial) + "\n" + print_machine(c));
        ASSERT_NO_THROW(check_consistency(c, "random"));
        if (c.all_threads() > 20) // which take long
            continue;
        expect_equal(c, "core");
        for (unsigned level = 1; c.sim.mode == "fast" && level <= c.tile_levels(); ++level)
            expect_equal(c, "l" + std::to_string(level));
        if (HasFailure())
            return;
    }
}

} // namespace
} // namespace sim::test
