// Caches that see each other's requests on buses.
#include "tests/sim/coherent.h"

#include <fmt/format.h>

namespace sim::test {
namespace {

TEST(Coherence, CountsOfCachesThatSnoopEqualTheTableToo) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        Config c = simple();
        c.chip.tiles = 2 + seed % 4;
        c.chip.cores = 1 + seed / 4;
        c = snooping(c, c.chip.tiles % 2 == 0 ? 1 + static_cast<integer>(seed / 4) % 2 : 1);
        const std::vector<Step> steps = random_steps(seed, 500, c, 5);
        CoherenceOracle oracle(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores));
        for (const Step& s : steps)
            oracle.access(s.tile, s.core, s.line, s.write);
        const Report r = act(c, steps);
        expect_equal(counts_of(r), oracle.counts(), fmt::format("seed {}", seed));
        EXPECT_EQ(r.coherence.forwards_stale + r.coherence.invalidations_stale, 0U);
        expect_equal(counts_of(act(in_order_of_time(c), steps)), oracle.counts(),
                     fmt::format("seed {}, reference mode", seed));
    }
}

// Who drops a line without a word says so when asked: the next one to read it has it alone.
TEST(Coherence, CachesThatSnoopSayWhatTheyDropped) {
    for (const bool snoops : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c.l2.ways = 1;
        c = snoops ? snooping(c, 1) : coherent(c);
        const int sets = static_cast<int>(c.l2.size_bytes / c.l2.line_bytes);
        // Both read the line, the first drops it, and so does the second, which then reads it again.
        const Report r = act(c, {{0, 0, 0, false},
                                 {1, 0, 0, false},
                                 {0, 0, sets, false},
                                 {1, 0, 2 * sets, false},
                                 {1, 0, 0, false}});
        EXPECT_EQ(r.coherence.exclusive, snoops ? 4U : 3U);
        EXPECT_EQ(r.coherence.snoops, snoops ? 5U : 0U);
    }
}

// What one tile reads of what another has changed, memory has as well, without a message.
TEST(Coherence, MemoryTakesWhatPasses) {
    Config c = simple();
    c.chip.tiles = 4;
    c = snooping(c, 2);
    const Report r = act(c, {{0, 0, 0, true}, {3, 0, 0, false}});
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
    EXPECT_EQ(r.coherence.written_back, 1U);
    EXPECT_EQ(r.memory.reads, 1U);
    EXPECT_EQ(r.memory.writes, 1U);
    EXPECT_EQ(r.network.counters.writes, 0U);
    EXPECT_EQ(r.coherence.passed_on, 2U);
    EXPECT_EQ(r.coherence.snoops, 2 * 3U);
}

} // namespace
} // namespace sim::test
