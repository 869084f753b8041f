// Of random machines in the fast mode, too, a trace that is replayed on the machine that made it gives all
// that the run counted, to the last one.
#include "tests/sim/random_machine.h"
#include "tests/sim/replay/compared.h"

#include <cstdlib>

namespace sim::test {
namespace {

/// RAZOR_RANDOM_MACHINES: how many (60), from RAZOR_RANDOM_FIRST (0) on, of RAZOR_RANDOM_OPERATIONS (50) a
/// thread.
int wanted(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atoi(text) : otherwise;
}

void expect_equal(const Config& config, const std::string& level, int count) {
    SCOPED_TRACE(level);
    TraceSettings settings;
    settings.level = level;
    const Recorded run = record(config, count, settings);
    const ReplayResult result = replay(run.trace, config);
    EXPECT_TRUE(result.ended);
    EXPECT_EQ(result.waits, 0U);
    EXPECT_EQ(differences(compare_with_run(result, print_json(run.report), "run")), "");
}

TEST(RandomReplay, CountsWhatTheRunCounted) {
    std::mt19937 random(2026);
    const int first = wanted("RAZOR_RANDOM_FIRST", 0);
    const int end = first + wanted("RAZOR_RANDOM_MACHINES", 60);
    const int operations = wanted("RAZOR_RANDOM_OPERATIONS", 50);
    ASSERT_GT(end, first);
    for (int trial = 0; trial < end; ++trial) {
        const Config c = random_machine(random);
        SCOPED_TRACE(std::to_string(trial) + "\n" + print_machine(c));
        ASSERT_NO_THROW(check_consistency(c, "random"));
        if (trial < first || c.sim.mode != "fast" || c.all_threads() > 20) // many take long
            continue;
        expect_equal(c, "core", operations);
        for (unsigned level = 1; level <= c.tile_levels(); ++level)
            expect_equal(c, "l" + std::to_string(level), operations);
        if (HasFailure())
            return;
    }
}

/// A part of a line was written in another cache, and what lay above the rest of it stayed.
TEST(RandomReplay, KeepsTheLawsWhereLinesAreWrittenInParts) {
    std::mt19937 random(2026);
    Config c;
    for (int trial = 0; trial <= 75; ++trial)
        c = random_machine(random);
    expect_equal(c, "core", 400);
}

/// Prefetchers learned from the site of somebody else's access (0, of the program's prefetches; 37, of a word
/// that was asked for again), or a word came to its L2 later than in the run (82).
TEST(RandomReplay, AlsoOfMachinesThatOnceDiffered) {
    std::mt19937 random(2026);
    for (int trial = 0; trial <= 82; ++trial) {
        const Config c = random_machine(random);
        SCOPED_TRACE(trial);
        if (trial == 0 || trial == 37 || trial == 82)
            expect_equal(c, "core", 120);
    }
}

} // namespace
} // namespace sim::test
