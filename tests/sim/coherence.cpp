// Coherence of plain data: who has which line, as a table of states says (coherence_oracle.h), what that
// takes, and that nothing else depends on it.
#include "sim/machine/energy.h"
#include "sim/validation/coherence_forms.h"
#include "tests/sim/coherent.h"
#include "tests/sim/networks.h"
#include "tests/sim/unchanging.h"

#include <fmt/format.h>

namespace sim::test {
namespace {

TEST(Coherence, CountsEqualATableOfStates) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        Config c = simple();
        c.chip.tiles = 1 + seed % 4;
        c.chip.cores = 1 + seed / 4;
        c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[seed % 4];
        if (seed % 3 == 0)
            c = with_l3(c, 2);
        c = coherent(c);
        const std::vector<Step> steps = random_steps(seed, 500, c, 5);
        CoherenceOracle oracle(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores));
        for (const Step& s : steps)
            oracle.access(s.tile, s.core, s.line, s.write);
        expect_equal(counts_of(act(c, steps)), oracle.counts(), fmt::format("seed {}", seed));
        expect_equal(counts_of(act(in_order_of_time(c), steps)), oracle.counts(),
                     fmt::format("seed {}, reference mode", seed));
    }
}

TEST(Coherence, NothingIsAskedWhereItIsOff) {
    Config c = simple();
    c.chip.tiles = 3;
    const std::vector<Step> steps = random_steps(1, 200, c, 5);
    const Report r = act(c, steps);
    EXPECT_EQ(r.cache_total(0).invalidations + r.cache_total(0).upgrades + r.cache_total(1).coherence, 0U);
    EXPECT_EQ(r.cache_total(1).misses, 15U) << "a line each";
    EXPECT_GT(act(coherent(c), steps).cache_total(1).coherence, 15U);
}

// An L1 that writes through asks nobody below for the right, but the L2 does; copies of the tile's other
// cores go.
TEST(Coherence, WritesThroughTakeOthersCopies) {
    for (const char* miss : {"allocate", "around"}) {
        Config c = simple();
        c.chip.tiles = c.chip.cores = 2;
        c.l1.write_policy = "through";
        c.l1.write_miss = miss;
        c = coherent(c);
        const auto counts = [&c](const std::vector<Step>& steps) { return act(c, steps); };
        Report r = counts({{0, 0, 0, false}, {0, 1, 0, false}, {0, 0, 0, true}, {0, 1, 0, false}});
        EXPECT_EQ(r.l1[1].invalidations, 1U);
        EXPECT_EQ(r.l1[1].misses, 2U);
        EXPECT_EQ(r.l1[0].misses, 1U);
        EXPECT_EQ(r.cache_total(1).upgrades, 0U) << "the tile has it alone";
        r = counts({{0, 0, 0, false}, {1, 0, 0, false}, {1, 1, 0, false}, {0, 0, 0, true}, {1, 1, 0, false}});
        EXPECT_EQ(r.cache_total(0).upgrades, 0U);
        EXPECT_EQ(r.l2[0].upgrades, 1U);
        EXPECT_EQ(r.l2[1].invalidations, 1U);
        EXPECT_EQ(r.l1[2].invalidations + r.l1[3].invalidations, 2U);
        EXPECT_EQ(r.coherence.forwards_dirty, 1U);
        r = counts({{0, 0, 0, false}, {1, 0, 0, true}});
        EXPECT_EQ(r.l1[0].invalidations, 1U);
        EXPECT_EQ(r.coherence.writes, 1U);
    }
}

// Three caches of a tile one below the other: who asks goes all the way down, and back up on the other side.
TEST(Coherence, InnerLevelsGiveLinesUpToo) {
    Config c = simple();
    c.chip.tiles = 2;
    c.chip.cores = 4;
    c.l2.share = "2";
    c.l3.size_bytes = 64 * kib;
    c.l3.share = "tile";
    c.l3.ways = 4;
    c.l3.line_bytes = 2 * c.l2.line_bytes;
    c = coherent(c);
    // Within the tile, from the other pair: the line comes from the L1 that changed it.
    Report r = act(c, {{0, 0, 0, true}, {0, 2, 0, false}, {0, 3, 0, true}});
    EXPECT_EQ(r.l1[0].downgrades, 1U);
    EXPECT_EQ(r.l2[0].downgrades, 1U);
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[2].invalidations, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 0U);
    EXPECT_EQ(r.coherence.writes, 1U);
    EXPECT_EQ(r.coherence.reads + r.coherence.upgrades, 0U) << "the tile has it";
    // From the other tile: two lines of the L2s are one of the L3.
    r = act(c, {{0, 0, 0, true}, {0, 2, 1, true}, {1, 1, 1, true}});
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[2].invalidations, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 1U);
    EXPECT_EQ(r.l3[0].invalidations, 1U);
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
}

// A write that passes by the caches of its pair is of a part of the other pair's line, which goes whole: with
// all that lies above it, the part that was not written too.
TEST(Coherence, LinesGoWholeWhateverPartIsWritten) {
    Config c = simple();
    c.chip.cores = 4;
    c.l2.share = "2";
    c.l2.line_bytes = 2 * c.l1.line_bytes;
    c.l3 = c.l2;
    c.l3.size_bytes = 64 * kib;
    c.l3.share = "tile";
    c.l1.write_miss = c.l2.write_miss = "around";
    const std::vector<Step> steps{{0, 0, 0, false}, {0, 1, 1, false}, {0, 0, 1, false}, {0, 2, 1, true},
                                  {0, 0, 0, false}, {0, 1, 1, false}, {0, 3, 1, false}};
    for (const Config& machine : {coherent(c), in_order_of_time(coherent(c))}) {
        SCOPED_TRACE(machine.sim.mode);
        const Report r = act(machine, steps);
        EXPECT_EQ(r.l2[0].invalidations, 1U);
        EXPECT_EQ(r.l1[0].invalidations, 2U);
        EXPECT_EQ(r.l1[1].invalidations, 1U);
        EXPECT_EQ(r.l1[0].misses, 3U);
        EXPECT_EQ(r.l1[1].misses, 2U);
    }
}

// A line that left without a word is asked of who had it in vain, one that was written back is not.
TEST(Coherence, WhatLeavesDirtyIsKnown) {
    for (const bool write : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c.l2.ways = 1;
        c = coherent(c);
        const int sets = static_cast<int>(c.l2.size_bytes / c.l2.line_bytes);
        const Report r = act(c, {{0, 0, 0, write}, {0, 0, sets, false}, {1, 0, 0, false}});
        EXPECT_EQ(r.l2[0].write_backs, write ? 1U : 0U);
        EXPECT_EQ(r.coherence.forwards_stale, write ? 0U : 1U);
        EXPECT_EQ(r.coherence.forwards, r.coherence.forwards_stale);
        EXPECT_EQ(r.memory.reads, 3U);
    }
}

// A word's writer takes its line from a tile that read plain data in it, and who writes words has their
// lines.
TEST(Coherence, SharedWordsAreInTheDirectory) {
    Config c = simple();
    c.chip.tiles = 2;
    c = coherent(c);
    const Shared s;
    const Report r = s.run(c, 2, [&](int w) {
        load(here, s.at(0), 4, stamp{});
        if (w == 0)
            release_after(s.at(0), 20000);
    });
    EXPECT_EQ(r.coherence.claims, 1U);
    EXPECT_EQ(r.coherence.invalidations_received, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 1U);
    expect_equal_on_host_threads(
        [&](int host_threads) {
            Config busy = coherent(busy_tiles());
            busy.network.topology = "ring";
            const Report words = run_busy_tiles(busy, host_threads);
            EXPECT_GT(words.coherence.writes, 100U);
            return words;
        },
        "words");
}

// Two tiles that share a line write it in one window: the second one's line is taken while it asks for the
// right, comes again, and stays.
TEST(Coherence, WhatIsAskedForAgainStays) {
    Config c = simple();
    c.chip.tiles = 2;
    c.sim.window = 5000;
    c.latency[static_cast<std::size_t>(operation::add)] = 5000;
    c.latency[static_cast<std::size_t>(operation::multiply)] = 50;
    const Report r = run_on(
        coherent(c),
        [](std::byte* base, int w) {
            load(here, base, 4, stamp{});
            const stamp later = scalar_op(operation::add, stamp{});
            store(here, base, 4, w == 0 ? later : scalar_op(operation::multiply, later), stamp{});
            stamp s = later;
            for (int i = 0; i < 4; ++i)
                s = scalar_op(operation::add, s);
            if (w == 1)
                load(here, base, 4, s);
        },
        2);
    EXPECT_EQ(r.coherence.upgrades, 2U);
    EXPECT_EQ(r.coherence.lost_upgrades, 1U);
    EXPECT_EQ(r.coherence.invalidations_stale, 1U);
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
    EXPECT_EQ(r.l2[1].misses, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
}

// What is written back when a frame ends stays in its cache, and the next frame finds it there.
TEST(Coherence, LinesOutliveAFrame) {
    isa::address_space space{std::uint64_t{1} << 20};
    std::byte* data = space.add("data", -1, std::uint64_t{1} << 16, false);
    Config c = simple();
    c.chip.tiles = 2;
    c = coherent(c);
    Report r;
    ASSERT_NO_THROW(r = Machine(c).run(space, 2, {{"work"}},
                                       [&](int w) {
                                           for (int i = 0; i < 8; ++i)
                                               store(here, data + (w * 8 + i) * 64, 4, stamp{}, stamp{});
                                       },
                                       1, {.frames = 2}));
    EXPECT_EQ(r.memory.writes, 16U);
    EXPECT_EQ(r.cache_total(1).misses, 0U);
    EXPECT_EQ(r.coherence.upgrades + r.coherence.silent_upgrades + r.coherence.writes, 0U);
}

// One access at a time: the windows' length does not matter.
TEST(Coherence, WindowsChangeNothingForWhoTakesTurns) {
    for (const std::string topology : {"ideal", "mesh", "bus", "bus above an L3"})
        expect_equal_in_windows(
            [&](integer window) {
                Config c = simple();
                c.core.window = 1;
                c.chip.tiles = 3;
                c.chip.cores = 2;
                c.network.topology = topology;
                c.sim.window = window;
                if (topology == "bus above an L3")
                    c = with_l3(c, 2);
                c = topology.starts_with("bus") ? snooping(c, 3) : coherent(c);
                return act(c, random_steps(7, 100, c, 4));
            },
            topology);
}

TEST(Coherence, LookUpsHaveTheirEnergy) {
    const auto part = [](const Report& r, const std::string& name) {
        for (const EnergyPart& p : energy_parts(r))
            if (p.part == name)
                return p;
        return EnergyPart{"none", 0, 0, ""};
    };
    const std::vector<Step> steps = {{0, 0, 0, true}, {1, 0, 0, false}, {0, 0, 0, true}, {2, 0, 1, false}};
    Config c = simple();
    c.chip.tiles = 3;
    EXPECT_EQ(part(act(c, steps), "directory").part, std::string("none"));
    c = coherent(c);
    c.energy.directory_pj = 20;
    c.energy.snoop_pj = 7;
    EXPECT_EQ(part(act(c, steps), "directory").events, 4U) << "two reads, a write, an upgrade";
    EXPECT_DOUBLE_EQ(part(act(c, steps), "directory").joules, 4 * 20e-12);
    EXPECT_EQ(part(act(c, steps), "snoops").part, std::string("none"));
    c.coherence.directory_entries = c.coherence.directory_ways = 1;
    EXPECT_EQ(part(act(c, steps), "directory").events, 5U) << "and a line recalled";
    c = snooping(c, 1);
    EXPECT_DOUBLE_EQ(part(act(c, steps), "snoops").joules, 4 * 2 * 7e-12);
    EXPECT_EQ(part(act(c, steps), "directory").part, std::string("none"));
}

TEST(Coherence, WhatItNeedsIsSaid) {
    const std::string on = "coherence.plain = \"directory\"\n";
    EXPECT_EQ(mistake(on + "l2.inclusion = \"inclusive\"\n"), "");
    EXPECT_NE(mistake(on).find("l2.inclusion must be inclusive, not none"), std::string::npos);
    EXPECT_NE(
        mistake(on + "l2.inclusion = \"inclusive\"\nl2.write_policy = \"through\"\n").find("l2.write_policy"),
        std::string::npos);
    EXPECT_EQ(mistake(on + "l2.inclusion = \"inclusive\"\nsim.mode = \"reference\"\n"), "");
    EXPECT_NE(mistake(on +
                      "l2.inclusion = \"inclusive\"\nchip.tiles = 4\nl3.size_bytes = 65536\nl3.ways = 8\n"
                      "l3.share = 8\n")
                  .find("l3.share"),
              std::string::npos);
    const std::string entries = on + "l2.inclusion = \"inclusive\"\ncoherence.directory_entries = ";
    EXPECT_EQ(mistake(entries + "24\n"), "");
    EXPECT_NE(mistake(entries + "20\n").find("no multiple of coherence.directory_ways, 8"),
              std::string::npos);
    const std::string snoops = "coherence.plain = \"snoop\"\nl2.inclusion = \"inclusive\"\n",
                      bus = "network.topology = \"bus\"\n";
    EXPECT_EQ(mistake(snoops + bus), "");
    EXPECT_NE(mistake(snoops).find("network.topology must be bus, not ideal"), std::string::npos);
    const std::string l3 = "chip.tiles = 4\nl3.size_bytes = 65536\nl3.ways = 8\n";
    EXPECT_EQ(mistake(snoops + bus + l3), "");
    EXPECT_EQ(mistake(snoops + bus + l3 + "network.buses = 2\nsim.mode = \"reference\"\n"), "");
    EXPECT_NE(mistake(snoops + bus + l3 + "l3.share = 8\n").find("l3.share must be chip, not 8"),
              std::string::npos);
    EXPECT_NE(mistake(bus + "chip.tiles = 4\nnetwork.buses = 3\n").find("make it a divisor"),
              std::string::npos);
}

TEST(Coherence, BrokenNumbersAreNoticed) {
    Config c = simple();
    c.chip.tiles = 2;
    const std::vector<Step> steps = {{0, 0, 0, true}, {1, 0, 0, false}, {0, 0, 0, true}};
    const Report snooped = act(snooping(c, 2), steps);
    EXPECT_NO_THROW(check_laws(snooped));
    for (const auto count : {&CoherenceCounters::snoops, &CoherenceCounters::passed_on,
                             &CoherenceCounters::acknowledgements, &CoherenceCounters::claims}) {
        Report r = snooped;
        ++(r.coherence.*count);
        EXPECT_THROW(check_laws(r), std::logic_error);
    }
    c = coherent(c);
    const Report good = act(c, steps);
    EXPECT_NO_THROW(check_laws(good));
    for (const auto& row : coherence_counters)
        if (row.count != &CoherenceCounters::wait_cycles && row.count != &CoherenceCounters::claims &&
            row.count != &CoherenceCounters::lost_upgrades) {
            Report r = good;
            ++(r.coherence.*row.count);
            EXPECT_THROW(check_laws(r), std::logic_error) << row.name;
        }
    Report r = good;
    ++r.incoherent_lines;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.l2[0].upgrades;
    EXPECT_THROW(check_laws(r), std::logic_error);
}

} // namespace
} // namespace sim::test
