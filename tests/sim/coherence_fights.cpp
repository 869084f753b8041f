// Tiles that fight for few lines, as chance wants it, on machines of chance: the laws hold, whatever the host
// does.
#include "sim/validation/coherence_forms.h"
#include "tests/sim/coherent.h"
#include "tests/sim/networks.h"
#include "tests/sim/unchanging.h"

#include <fmt/format.h>

#include <random>

namespace sim::test {
namespace {

/// Loads and stores of few lines by all threads, as chance wants it.
Report contend(const Config& c, std::uint32_t seed, int host_threads = 1, const RunOptions& options = {}) {
    Memory memory;
    return Machine(c).run(
        memory.space, static_cast<int>(c.all_threads()), {{"work"}},
        [&](int w) {
            std::mt19937 random(seed * 1000 + static_cast<std::uint32_t>(w));
            stamp last;
            for (int i = 0; i < 150; ++i) {
                std::byte* p = memory.data + random() % 40 * 64 + random() % 16 * 4;
                std::byte* far = memory.more + random() % 4096 * 64;
                switch (random() % 6) {
                case 0:
                    store(here, p, 4, last, stamp{});
                    break;
                case 1:
                    store_vector(here, p, all_lanes, last, stamp{}, stamp{});
                    break;
                case 2:
                    load(here, far, 4, last);
                    break;
                case 3:
                    isa::timing::prefetch(here, p, last);
                    break;
                case 4:
                    load(here, p, 4, stamp{});
                    break;
                default:
                    last = load(here, p, 4, last);
                }
            }
        },
        host_threads, options);
}

/// Tiles that fight for lines, with caches that keep few of them.
Config fighting(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto pick = [&](std::initializer_list<integer> all) { return all.begin()[random() % all.size()]; };
    Config c;
    c.chip.tiles = pick({2, 3, 5, 8});
    c.chip.cores = pick({1, 2, 4});
    c.chip.threads = pick({1, 2});
    c.core.window = pick({1, 8, 60});
    c.core.store_buffer = pick({0, 4});
    c.l1.size_bytes = pick({256, 1024, 8192});
    c.l1.ways = 2;
    c.l1.line_bytes = pick({32, 64});
    c.l1.mshrs = pick({1, 4, 16});
    c.l1.write_policy = pick({0, 3}) == 0 ? "through" : "back";
    c.l1.prefetcher = "none";
    c.l2.size_bytes = pick({1024, 4096, 65536});
    c.l2.ways = 4;
    c.l2.line_bytes = pick({64, 128});
    c.l2.mshrs = pick({1, 3, 16});
    c.l2.write_back_buffer = pick({1, 8});
    if (c.chip.cores == 4 && pick({0, 1}) == 0) {
        c.l2.share = std::string("2");
        if (pick({0, 1}) == 0) {
            c.l3.size_bytes = 8192;
            c.l3.line_bytes = 128;
            c.l3.ways = 4;
            c.l3.share = std::string("tile");
        }
    }
    if (c.l3.size_bytes == 0 && pick({0, 1}) == 0) {
        c.l3.size_bytes = pick({8192, 262144});
        c.l3.line_bytes = 128;
        c.l3.ways = 8;
        c.l3.mshrs = pick({1, 16});
        c.l3.share = std::string("chip");
        c.l3.inclusion = pick({0, 1}) == 0 ? "none" : "inclusive";
    }
    c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[random() % 4];
    c.network.link_bytes = pick({2, 32});
    c.coherence.directory_cycles = pick({1, 6, 200});
    c.memory.channels = pick({1, 2});
    c.sim.quantum = pick({0, 10, 1000});
    c.sim.window = pick({0, 0, 30, 500, 5000});
    c.sim.miss_causes = pick({0, 1}) == 0 ? "on" : "off";
    c.sim.jitter = pick({0, 1});
    return coherent(c);
}

/// The same with directories that have room for few lines.
Config fighting_for_entries(std::uint32_t seed) {
    Config c = fighting(seed);
    c.coherence.directory_ways = std::array{1, 2, 4}[seed % 3];
    c.coherence.directory_entries = c.coherence.directory_ways * std::array{1, 4, 16}[seed / 3 % 3];
    return c;
}

struct Fought : CoherenceCounters {
    std::uint64_t lost_within_tiles = 0;     // upgrades
    std::uint64_t hits_beyond_the_tiles = 0; // of an L3
};

/// What so many of these machines count together; the laws say that every copy is known, and that one cache
/// alone may write a line.
template <class Machine> Fought fight(Machine machine, std::uint32_t seeds) {
    Fought sum;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Config c = machine(seed);
        EXPECT_NO_THROW(check_consistency(c, "fighting")) << seed;
        Report r;
        EXPECT_NO_THROW(r = contend(c, seed)) << seed;
        for (const auto& row : coherence_counters)
            sum.*row.count += r.coherence.*row.count;
        for (unsigned level = 0; level < c.tile_levels(); ++level)
            sum.lost_within_tiles += r.cache_total(level).lost_upgrades;
        if (c.tile_levels() != c.cache_levels())
            sum.hits_beyond_the_tiles += r.cache_total(c.tile_levels()).hits;
    }
    return sum;
}

TEST(Coherence, TilesThatFightKeepTheLaws) {
    const Fought all = fight(fighting, 300);
    EXPECT_GT(all.lost_upgrades, 100U);
    EXPECT_GT(all.silent_upgrades, 100U);
    EXPECT_GT(all.invalidations_stale, 100U);
    EXPECT_GT(all.forwards_dirty, 1000U);
    EXPECT_GT(all.wait_cycles, 1000U);
}

TEST(Coherence, TilesThatFightForEntriesKeepTheLaws) {
    const Fought all = fight(fighting_for_entries, 300);
    EXPECT_GT(all.recalls_received, 10000U);
    EXPECT_GT(all.recalls_stale, 1000U);
    EXPECT_GT(all.crowded, 100U);
    EXPECT_GT(all.lost_upgrades, 100U);
}

/// The same on buses; above an L3 where one lies beyond the tiles.
Config fighting_on_buses(std::uint32_t seed) {
    Config c = fighting(seed);
    c.coherence.snoop_cycles = std::array{1, 6, 200}[seed % 3];
    return snooping(c, c.chip.tiles == 8   ? integer{1} << (seed / 3 % 4)
                       : c.chip.tiles == 2 ? 1 + seed % 2
                                           : 1);
}

TEST(Coherence, TilesThatFightOnBusesKeepTheLaws) {
    const Fought all = fight(fighting_on_buses, 300);
    EXPECT_GT(all.hits_beyond_the_tiles, 10000U);
    EXPECT_GT(all.lost_upgrades, 50U);
    EXPECT_GT(all.silent_upgrades, 50U);
    EXPECT_GT(all.forwards_dirty, 1000U);
    EXPECT_GT(all.passed_on, 1000U);
}

// A line that its first reader is still being brought waits for that before it goes on to the second, which
// is as late in both modes.
TEST(Coherence, LinesGoOnWhenTheirOwnersHaveThem) {
    for (const std::string topology : {"crossbar", "bus", "bus above an L3", "bus above a busy L3"}) {
        const auto read_by_two = [&](const std::string& mode) {
            const bool bus = topology.starts_with("bus");
            Config c = coherent_machine(bus ? "bus" : topology, 12, mode);
            if (bus)
                c.coherence.plain = "snoop";
            if (topology.ends_with("L3"))
                c = with_l3(c, 1);
            const bool busy = topology.ends_with("busy L3");
            c.l3.bank_bytes = busy ? 1 : c.l3.bank_bytes; // for 64 cycles, by the first one's line
            return run_on(
                c,
                [busy](std::byte* base, int worker) {
                    if (worker == 3 || worker == 8)
                        load(here, base, 4, stamp{});
                    if (busy && worker == 0)
                        load(here, base + 64, 4, stamp{});
                },
                12);
        };
        const Report fast = read_by_two("fast"), reference = read_by_two("reference");
        EXPECT_GT(fast.coherence.wait_cycles, 0U) << topology;
        EXPECT_GT(reference.coherence.wait_cycles, 0U) << topology;
        EXPECT_EQ(reference.cycles, fast.cycles) << topology;
        EXPECT_EQ(reference.coherence.forwards_clean, 1U) << topology;
    }
}

// Two cores of a tile write a line of a third at once, in order of time: the first one's request leaves the
// second's line, which that is still asking for, alone.
TEST(Coherence, WhatACoreAsksForStays) {
    Config c = simple();
    c.chip.cores = 3;
    c.chip.placement = "pack";
    c.latency[static_cast<std::size_t>(operation::add)] = 4000;
    const Report r = run_on(
        in_order_of_time(coherent(c)),
        [](std::byte* base, int worker) {
            if (worker == 2) {
                load(here, base, 4, stamp{});
                return;
            }
            const stamp later = scalar_op(operation::add, stamp{});
            store(here, base, 4, later, stamp{});
            if (worker == 1)
                load(here, base, 4, scalar_op(operation::add, later));
        },
        3);
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[2].invalidations, 1U);
    EXPECT_EQ(r.l1[1].invalidations, 0U);
    EXPECT_EQ(r.l1[1].misses, 1U);
    EXPECT_EQ(r.l1[1].hits, 1U);
}

// A line that a core has written and throws out is read by another tile, whose request may find it in the
// core's L1, on its way to the L2, or there: what is written is brought along once, and from there it is
// clean.
TEST(Coherence, WhatIsOnItsWayDownGoesAlong) {
    Config c = in_order_of_time(coherent(simple()));
    c.chip.tiles = 2;
    c.chip.placement = "spread";
    c.latency[static_cast<std::size_t>(operation::add)] = 4000;
    c.latency[static_cast<std::size_t>(operation::multiply)] = 1;
    c.l1.ways = 1;
    for (int delay = 0; delay < 300; ++delay) {
        const Report r = run_on(
            c,
            [&](std::byte* base, int worker) {
                std::byte* other = base + c.l1.size_bytes; // of the same set
                if (worker == 0)
                    store(here, base, 4, load(here, other, 4, stamp{}), stamp{});
                stamp clock = scalar_op(operation::add, stamp{});
                for (int i = worker == 0 ? delay : 150; i > 0; --i)
                    clock = scalar_op(operation::multiply, clock);
                load(here, worker == 0 ? other : base, 4, clock);
            },
            2);
        EXPECT_EQ(r.coherence.forwards_dirty, 1U) << delay;
        EXPECT_EQ(r.memory.writes, 1U) << delay;
    }
}

// An L1 writes a line back while the L2 drops it for another core's: it leaves the tile once, with what the
// L1 had changed, and comes back to nobody.
TEST(Coherence, AWriteBackOnItsWayLeavesWithItsLine) {
    for (const bool directory : {true, false}) {
        Config c = simple();
        c.chip.cores = 2;
        c.l1.size_bytes = 1024;
        c.l2.size_bytes = 4096;
        c.l1.ways = c.l2.ways = 1;
        c.l2.inclusion = "inclusive";
        c = in_order_of_time(directory ? coherent(c) : c);
        for (cycle delay = 0; delay < 40; ++delay) {
            const Report r = run_on(
                c,
                [&](std::byte* base, int worker) {
                    std::byte* same_in_l1 = base + 1024;
                    std::byte* same_in_both = base + 4096;
                    if (worker == 0) {
                        store(here, base, 4, stamp{}, stamp{});
                        load(here, same_in_l1, 4, stamp{5000, 5000});
                    } else {
                        load(here, same_in_both, 4, stamp{4980 + delay, 4980 + delay});
                    }
                },
                2);
            EXPECT_EQ(r.memory.writes, 1U) << delay;
            EXPECT_EQ(r.l2[0].fills, 3U) << delay;
            EXPECT_EQ(r.l2[0].write_backs, 1U) << delay;
        }
    }
}

// In order of time a request may find that its line has gone while it was on its way within the tile.
TEST(Coherence, TilesThatFightInOrderOfTimeKeepTheLaws) {
    const auto fight_in_order = [](Config (*machine)(std::uint32_t)) {
        return fight([machine](std::uint32_t seed) { return in_order_of_time(machine(seed)); }, 100);
    };
    Fought all = fight_in_order(fighting);
    EXPECT_GT(all.lost_upgrades, 10U);
    EXPECT_GT(all.silent_upgrades, 10U);
    EXPECT_GT(all.forwards_dirty, 300U);
    EXPECT_GT(all.wait_cycles, 300U);
    EXPECT_GT(all.lost_within_tiles, 10U);
    all = fight_in_order(fighting_for_entries);
    EXPECT_GT(all.recalls_received, 1000U);
    all = fight_in_order(fighting_on_buses);
    EXPECT_GT(all.hits_beyond_the_tiles, 1000U);
    EXPECT_GT(all.forwards_dirty, 300U);
    EXPECT_GT(all.passed_on, 300U);
}

TEST(Coherence, ReportsDoNotDependOnTheHost) {
    int above_l3 = 0;
    for (std::uint32_t seed = 1; seed <= 17; ++seed) {
        Config c = seed <= 8    ? fighting(seed)
                   : seed <= 12 ? fighting_for_entries(seed)
                                : fighting_on_buses(seed);
        above_l3 += c.coherence.snoops() && c.l3.share == "chip" && c.l3.size_bytes != 0 ? 1 : 0;
        if (seed % 2 == 0)
            c = in_order_of_time(c);
        expect_equal_on_host_threads([&](int threads) { return contend(c, seed, threads); },
                                     fmt::format("seed {}", seed));
        expect_equal_in_any_order(
            [&](std::uint32_t order) { return contend(c, seed, 1, {.host_order = order}); },
            fmt::format("seed {}", seed));
    }
    EXPECT_GE(above_l3, 2);
}

} // namespace
} // namespace sim::test
