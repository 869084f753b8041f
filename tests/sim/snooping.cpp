// Caches that see each other's requests on buses, with memory beyond them, or a cache that they share.
#include "sim/machine/windows.h"
#include "tests/sim/cache_oracle.h"
#include "tests/sim/coherent.h"
#include "tests/sim/networks.h"

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

/// What a cache beyond the tiles is asked for: lines that no other tile brings, and what others read of what
/// one has changed.
class SharedCacheTable {
public:
    SharedCacheTable(const Config& c, bool around)
        : table_(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores)),
          l3_({u(c.l3.size_bytes), u(c.l3.ways), u(c.l3.line_bytes), "lru", around, around}) {}

    void access(const Step& s) {
        const OracleCounts before = table_.counts();
        table_.access(s.tile, s.core, s.line, s.write);
        reads_ += table_.counts().fetched - before.fetched;
        for (std::uint64_t i = before.fetched; i < table_.counts().fetched; ++i)
            l3_.access(u(s.line) * 64, false, 64);
        for (std::uint64_t i = before.l2_downgrades; i < table_.counts().l2_downgrades; ++i)
            l3_.access(u(s.line) * 64, true, 64);
    }
    void expect_equal_to(const Report& r, const std::string& what) const {
        expect_equal(counts_of(r), table_.counts(), what);
        const CacheCounters l3 = r.cache_total(2);
        EXPECT_EQ(l3.reads, reads_) << what;
        EXPECT_EQ(l3.writes, l3_.accesses - reads_) << what;
        EXPECT_EQ(l3.hits, l3_.hits) << what;
        EXPECT_EQ(l3.misses, l3_.misses) << what;
        EXPECT_EQ(l3.compulsory, l3_.compulsory) << what;
        EXPECT_EQ(l3.capacity, l3_.capacity) << what;
        EXPECT_EQ(l3.conflict, l3_.conflict) << what;
        EXPECT_EQ(l3.fills, l3_.fills) << what;
        EXPECT_EQ(l3.write_backs, l3_.write_backs) << what;
        EXPECT_EQ(l3.written_through, l3_.written_through) << what;
        EXPECT_EQ(r.memory.reads, l3_.fills) << what;
        EXPECT_EQ(r.memory.writes, l3_.write_backs + l3_.written_through) << what;
    }
    const CacheOracle& l3() const { return l3_; }

private:
    CoherenceOracle table_;
    CacheOracle l3_;
    std::uint64_t reads_ = 0;
};

/// A machine whose tiles snoop above an L3 of so many lines.
Config above_l3(Config c, integer buses, integer lines, integer ways, integer banks = 1) {
    c = with_l3(c, banks);
    c.l3.size_bytes = lines * 64;
    c.l3.ways = ways;
    return snooping(c, buses);
}

TEST(Coherence, CountsOfCachesThatSnoopAboveASharedOneEqualTables) {
    std::uint64_t hits = 0, misses = 0, written = 0;
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        Config c = simple();
        c.chip.tiles = 2 + seed % 4;
        c.chip.cores = 1 + seed / 4 % 3;
        const integer buses = c.chip.tiles % 2 == 0 ? 1 + static_cast<integer>(seed / 4) % 2 : 1;
        c = above_l3(c, buses, std::array{4, 8, 16, 1024}[seed % 4], 2, integer{1} << (seed % 3));
        const bool around = seed % 5 == 0;
        c.l3.write_policy = around ? "through" : "back";
        c.l3.write_miss = around ? "around" : "allocate";
        EXPECT_NO_THROW(check_consistency(c, "above an L3"));
        const std::vector<Step> steps = random_steps(seed, 500, c, 11);
        SharedCacheTable shared(c, around);
        for (const Step& s : steps)
            shared.access(s);
        shared.expect_equal_to(act(c, steps), fmt::format("seed {}", seed));
        Config queued = c;
        queued.memory.controller = "queued";
        shared.expect_equal_to(act(queued, steps), fmt::format("seed {}, queued memory", seed));
        shared.expect_equal_to(act(in_order_of_time(c), steps), fmt::format("seed {}, reference mode", seed));
        hits += shared.l3().hits;
        misses += shared.l3().misses;
        written += shared.l3().write_backs;
    }
    EXPECT_GT(hits, 500U);
    EXPECT_GT(misses, 500U);
    EXPECT_GT(written, 100U);
}

// ... and the cache that tiles share in memory's place; it answers the next reader.
TEST(Coherence, TheSharedCacheTakesWhatPasses) {
    for (const bool reference : {false, true}) {
        Config c = simple();
        c.chip.tiles = 4;
        c = above_l3(c, 2, 1024, 4);
        const std::vector<Step> steps = {{0, 0, 0, true}, {3, 0, 0, false}, {1, 0, 0, false}};
        const Report r = act(reference ? in_order_of_time(c) : c, steps);
        EXPECT_EQ(r.coherence.forwards_dirty, 1U);
        EXPECT_EQ(r.coherence.written_back, 1U);
        EXPECT_EQ(r.l3[0].reads, 2U);
        EXPECT_EQ(r.l3[0].writes, 1U);
        EXPECT_EQ(r.l3[0].misses, 1U);
        EXPECT_EQ(r.memory.reads, 1U);
        EXPECT_EQ(r.memory.writes, 0U);
        EXPECT_EQ(r.network.counters.writes, 0U);
        EXPECT_EQ(r.coherence.passed_on, 3U);
        EXPECT_EQ(r.coherence.snoops, 3 * 3U);
        EXPECT_EQ(r.network.counters.requests, 3U + 1U) << "tiles', and the L3's";
    }
}

// What a tile throws out changed the next one finds there; what it throws out itself tiles lose, if it is
// inclusive, and who asks then has it alone.
TEST(Coherence, LinesThatLeaveTilesOrTheSharedCacheAreKnown) {
    for (const bool reference : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c = above_l3(c, 2, 1024, 4);
        Config small = c;
        small.l2.ways = 1;
        const int sets = static_cast<int>(small.l2.size_bytes / 64);
        const std::vector<Step> steps = {{0, 0, 0, true}, {0, 0, sets, false}, {1, 0, 0, false}};
        Report r = act(reference ? in_order_of_time(small) : small, steps);
        EXPECT_EQ(r.l2[0].write_backs, 1U);
        EXPECT_EQ(r.l3[0].reads, 3U);
        EXPECT_EQ(r.l3[0].writes, 1U);
        EXPECT_EQ(r.l3[0].hits, 2U);
        EXPECT_EQ(r.coherence.forwards, 0U);
        EXPECT_EQ(r.memory.reads, 2U);
        EXPECT_EQ(r.memory.writes, 0U);

        small = above_l3(c, 2, 4, 1);
        small.l3.inclusion = "inclusive";
        const std::vector<Step> more = {{0, 0, 0, true}, {1, 0, 4, false}, {1, 0, 0, false}};
        r = act(reference ? in_order_of_time(small) : small, more);
        EXPECT_EQ(r.l2[0].back_invalidations, 1U);
        EXPECT_EQ(r.l3[0].write_backs, 1U);
        EXPECT_EQ(r.coherence.forwards, 0U);
        EXPECT_EQ(r.coherence.exclusive, 2U);
        EXPECT_EQ(r.memory.reads, 3U);
        EXPECT_EQ(r.memory.writes, 1U);
    }
}

// Lines that tiles bring, and rights to write, take none of its banks.
TEST(Coherence, SharedCachesAreBusyWithTheirOwnLinesAlone) {
    for (const bool reference : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c = above_l3(c, 1, 1024, 4);
        c.l3.bank_bytes = 16;
        // Read, brought clean, right; brought changed and written back, right.
        const std::vector<Step> steps = {
            {0, 0, 0, false}, {1, 0, 0, false}, {0, 0, 0, true}, {1, 0, 0, false}, {1, 0, 0, true}};
        const Report r = act(reference ? in_order_of_time(c) : c, steps);
        EXPECT_EQ(r.coherence.supplied(), 2U);
        EXPECT_EQ(r.coherence.upgrades, 2U);
        EXPECT_EQ(r.l3[0].reads, 1U);
        EXPECT_EQ(r.l3[0].writes, 1U);
        EXPECT_EQ(r.l3[0].busy_cycles, 2 * 4U);
    }
}

// Who asks for a right and has lost the line meanwhile takes it for a whole line.
TEST(Coherence, LinesThatWereLostComeFromTheSharedCache) {
    Config c = simple();
    c.chip.tiles = 2;
    c.sim.window = 5000;
    c.latency[static_cast<std::size_t>(operation::add)] = 5000;
    c.latency[static_cast<std::size_t>(operation::multiply)] = 300;
    c.latency[static_cast<std::size_t>(operation::divide)] = 100;
    c = above_l3(c, 1, 1024, 4);
    c.l2.ways = 1;
    c.l3.bank_bytes = 16;
    const int sets = static_cast<int>(c.l2.size_bytes / c.l2.line_bytes);
    const Report r = run_on(
        c,
        [sets](std::byte* base, int w) {
            // Both have the line, and write it in one window; the first one throws it out in between.
            load(here, base, 4, stamp{});
            const stamp later = scalar_op(operation::add, stamp{});
            store(here, base, 4, w == 0 ? later : scalar_op(operation::multiply, later), stamp{});
            if (w == 0)
                load(here, base + sets * 64, 4, scalar_op(operation::divide, later));
        },
        2);
    EXPECT_EQ(r.coherence.upgrades, 2U);
    EXPECT_EQ(r.coherence.lost_upgrades, 1U);
    EXPECT_EQ(r.coherence.supplied(), 1U) << "when both read it";
    EXPECT_EQ(r.l3[0].reads, 3U) << "the line, another one, and the line again";
    EXPECT_EQ(r.l3[0].busy_cycles, (r.l3[0].reads + r.l3[0].writes) * 4);
}

TEST(Coherence, TheSharedCachesWindowEndsWhenATileMayHaveAnswered) {
    Config c = simple();
    c.chip.tiles = 4;
    c = above_l3(c, 2, 1024, 4);
    c.network.link_bytes = 16;
    c.network.hop_cycles = 7;
    const cycle back = 7 + flits(c, c.network.reply_bytes + 64);
    c.coherence.snoop_cycles = 200;
    EXPECT_EQ(window_cycles(c), u(c.l3.latency) + back);
    c.coherence.snoop_cycles = 3;
    EXPECT_EQ(window_cycles(c), std::min(u(c.l3.latency), 3 + u(c.l2.latency)) + back);
}

} // namespace
} // namespace sim::test
