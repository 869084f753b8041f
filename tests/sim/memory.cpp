// Closed forms of the memory system; caches.cpp compares what they hold.
#include "tests/sim/machines.h"

#include <algorithm>
#include <array>

namespace sim::test {
namespace {

constexpr integer line = 64;

/// Core cycles of an idle memory read whose row is closed, as the L2 sees it; clocks chosen equal.
cycle idle_read(const Config& c) {
    return u(c.memory.controller_cycles + c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks());
}
Config equal_clocks() {
    Config c = simple();
    c.memory.clock_ps = c.chip.clock_ps;
    return c;
}

/// Each load's address waits for the load before; `lines` lines `stride` apart, `turns` times over.
Report chase(const Config& c, int lines, integer stride, int turns) {
    return run_on(c, [=](std::byte* base, int) {
        stamp s;
        for (int t = 0; t < turns; ++t)
            for (int i = 0; i < lines; ++i)
                s = load(here, base + i * stride, 4, s);
    });
}

TEST(Caches, PointerChaseInTheL1) {
    Config c = equal_clocks();
    cycle once = chase(c, 8, line, 1).cycles;
    EXPECT_EQ(chase(c, 8, line, 101).cycles - once, u(100 * 8 * c.l1.latency));
}

TEST(Caches, PointerChaseInTheL2) {
    Config c = equal_clocks();
    int lines = static_cast<int>(2 * c.l1.size_bytes / line);
    cycle once = chase(c, lines, line, 1).cycles;
    EXPECT_EQ(chase(c, lines, line, 11).cycles - once, u(10 * lines * (c.l1.latency + c.l2.latency)));
}

TEST(Caches, PointerChaseInMemory) {
    Config c = equal_clocks();
    // One line a row and bank: every access finds another row open, long ago.
    integer rows = c.memory.row_bytes * c.memory.banks;
    int lines = 100;
    Report r = chase(c, lines, rows, 1);
    cycle conflict = u(c.l1.latency + c.l2.latency + c.memory.tRP) + idle_read(c);
    EXPECT_EQ(r.cycles, u(c.l1.latency + c.l2.latency) + idle_read(c) + u(lines - 1) * conflict);
    EXPECT_EQ(r.memory.row_conflicts, u(lines - 1));
    EXPECT_EQ(r.memory.row_empties, 1U);
}

TEST(Memory, RowHitEmptyConflict) {
    Config c = equal_clocks();
    cycle other = u(c.l1.latency + c.l2.latency);
    integer rows = c.memory.row_bytes * c.memory.banks;
    auto second = [&](integer offset) {
        cycle first = 0, next = 0;
        run_on(c, [&](std::byte* base, int) {
            stamp one = load(here, base, 4, stamp{});
            first = when(one);
            next = when(load(here, base + offset, 4, one));
        });
        return next - first;
    };
    EXPECT_EQ(second(line), other + idle_read(c) - u(c.memory.tRCD)); // hit
    EXPECT_EQ(second(c.memory.row_bytes), other + idle_read(c));      // another bank
    EXPECT_EQ(second(rows), other + idle_read(c) + u(c.memory.tRP));  // conflict
    c.memory.tRAS = c.memory.tRC = 200;                               // the row may not be closed before
    EXPECT_EQ(second(rows), u(200 + c.memory.tRP));
}

// All ask at once; each gets the MSHR when the line before is there, in the order in which they asked.
TEST(Memory, WhoWaitsForAnMshrHasItInTurn) {
    Config c = equal_clocks();
    c.l1.mshrs = 16;
    for (integer mshrs : {1, 2}) {
        c.l2.mshrs = mshrs;
        constexpr int lines = 9;
        std::array<cycle, lines> ready{};
        run_on(c, [&](std::byte* base, int) {
            std::array<stamp, lines> s;
            for (int i = 0; i < lines; ++i)
                s[static_cast<std::size_t>(i)] = load(here, base + (lines - i) * line, 4, stamp{});
            for (std::size_t i = 0; i < lines; ++i)
                ready[i] = when(s[i]);
        });
        const cycle hit = idle_read(c) - u(c.memory.tRCD);
        for (std::size_t i = u(mshrs); i < lines; ++i)
            EXPECT_EQ(ready[i], ready[i - u(mshrs)] + hit) << mshrs << " MSHRs, line " << i;
    }
}

TEST(Memory, RefreshBlocksAndClosesRows) {
    Config c = equal_clocks();
    c.memory.tREFI = 1000;
    c.memory.tRFC = 100;
    cycle other = u(c.l1.latency + c.l2.latency);
    cycle late = 0;
    run_on(c, [&](std::byte* base, int) {
        load(here, base, 4, stamp{});
        stamp at{1000 - other, 1000 - other};
        late = when(load(here, base + line, 4, at)); // reaches memory at 1000 + 5: inside the refresh
    });
    EXPECT_EQ(late, u(1100 + c.memory.tRCD + c.memory.tCL + 4 + c.memory.controller_cycles / 2));
}

// Independent line loads are bounded by the memory bus: 64 bytes in 4 clocks.
TEST(Memory, StreamIsBoundedByTheBus) {
    Config c = equal_clocks();
    c.l1.mshrs = c.l2.mshrs = 64;
    int lines = 4096;
    Report r = run_on(c, [=](std::byte* base, int) {
        for (int i = 0; i < lines; ++i)
            load(here, base + i * line, 4, stamp{});
    });
    EXPECT_GE(r.cycles, u(4 * lines));
    EXPECT_LE(r.cycles, u(4 * lines) * 103 / 100); // the first access, and a conflict in each row
    EXPECT_GT(static_cast<double>(r.memory.busy_clocks) / static_cast<double>(r.memory.last_clock), 0.97);
}

TEST(Memory, ChannelsAddUp) {
    Config c = equal_clocks();
    c.l1.mshrs = c.l2.mshrs = 256;
    c.core.window = 1;
    auto stream = [](std::byte* base, int) {
        for (int i = 0; i < 4096; ++i)
            load(here, base + i * line, 4, stamp{});
    };
    cycle one = run_on(c, stream).cycles;
    c.memory.channels = 2;
    cycle two = run_on(c, stream).cycles;
    EXPECT_NEAR(static_cast<double>(one) / static_cast<double>(two), 2.0, 0.1);
}

TEST(Caches, MshrsLimitWhatIsOutstanding) {
    for (integer mshrs : {1, 2, 4}) {
        Config c = equal_clocks();
        c.l1.mshrs = mshrs;
        int lines = static_cast<int>(c.l2.size_bytes / line / 2);
        auto body = [=](int turns) {
            return run_on(c,
                          [=](std::byte* base, int) {
                              for (int t = 0; t < turns; ++t)
                                  for (int i = 0; i < lines; ++i)
                                      load(here, base + i * line, 4, stamp{});
                          })
                .cycles;
        };
        // In the L2, Little: mshrs lines every l1 + l2 latency.
        cycle each = (body(3) - body(2)) * u(mshrs) / u(lines);
        EXPECT_NEAR(static_cast<double>(each), static_cast<double>(c.l1.latency + c.l2.latency), 1.0)
            << mshrs;
    }
}

TEST(Caches, HitsUnderAMissMerge) {
    Config c = equal_clocks();
    stamp a, b;
    Report r = run_on(c, [&](std::byte* base, int) {
        a = load(here, base, 4, stamp{});
        b = load(here, base + 32, 4, stamp{});
    });
    EXPECT_EQ(a.last, b.last);
    EXPECT_EQ(r.l1[0].misses, 1U);
    EXPECT_EQ(r.l1[0].hits_in_flight, 1U);
    EXPECT_EQ(r.l2_total().reads, 1U);
}

// The line comes in the same window, but the load that hits it has to wait for the ports for longer.
TEST(Caches, HitsUnderAMissWaitForThePorts) {
    Config c = equal_clocks();
    c.l1.port_bytes = 4;
    const int between = 5;
    const int slots = std::min(ISA_WIDTH, 16); // of what one line has of a vector
    const std::uint64_t line_lanes = (std::uint64_t{1} << slots) - 1;
    stamp miss;
    Answered hit;
    run_on(c, [&](std::byte* base, int) {
        std::byte* there = base + 65536;
        load_vector(here, there, all_lanes, stamp{}, stamp{});
        stamp begin{1000, 1000};
        miss = load_vector(here, base, line_lanes, begin, stamp{});
        for (int i = 0; i < between; ++i)
            load_vector(here, there, all_lanes, begin, stamp{});
        stamp later = load_vector(here, base, line_lanes, begin, stamp{});
        ASSERT_TRUE(is_ticket(miss.last) && is_ticket(later.last));
        hit = running_engine->await(*running_hart, later.last);
        miss.last = when(miss);
    });
    cycle port = 1000 + u(slots + between * ISA_WIDTH); // a slot a cycle, taken in order
    EXPECT_LT(miss.last, port);
    EXPECT_EQ(hit.first, port + u(c.l1.latency));
    EXPECT_EQ(hit.last, port + u(slots - 1 + c.l1.latency));
}

TEST(Caches, VectorAccessesCountInstructionsAndLines) {
    Config c = equal_clocks();
    c.core.lanes = 4;
    c.l1.port_bytes = 16;
    Report r = run_on(c, [](std::byte* base, int) {
        load_vector(here, base, all_lanes, stamp{}, stamp{});     // aligned: an access a piece
        load_vector(here, base + 4, all_lanes, stamp{}, stamp{}); // one piece in each line end straddles
        load_vector(here, base, 0b1, stamp{}, stamp{});           // one lane, one access
        load_vector(here, base, 0, stamp{}, stamp{});             // none
    });
    auto pieces = u(ISA_WIDTH / 4);
    auto straddles = u((ISA_WIDTH * 4 + 4 - 1) / 64);
    EXPECT_EQ(r.l1[0].reads, pieces + (pieces + straddles) + 1);
    EXPECT_EQ(r.core.loads, 4U);
    EXPECT_EQ(r.core.instructions, 4 * pieces);
}

TEST(Caches, GathersPayPerLineOrPerLane) {
    Config c = equal_clocks();
    std::int32_t same[64] = {}, apart[64], pairs[64];
    for (int i = 0; i < 64; ++i) {
        apart[i] = i * 16;
        pairs[i] = i / 2 * 16;
    }
    auto accesses = [&](const std::int32_t* index, std::uint64_t lanes) {
        return run_on(c,
                      [&](std::byte* base, int) {
                          isa::timing::gather(here, base, index, lanes, stamp{}, stamp{}, stamp{});
                      })
            .l1[0]
            .reads;
    };
    EXPECT_EQ(accesses(same, all_lanes), 1U);
    EXPECT_EQ(accesses(apart, all_lanes), u(ISA_WIDTH));
    EXPECT_EQ(accesses(pairs, all_lanes), u(ISA_WIDTH / 2));
    EXPECT_EQ(accesses(apart, 0b101), 2U);
    c.core.lanes = 4; // each instruction on its own
    EXPECT_EQ(accesses(same, all_lanes), u(ISA_WIDTH / 4));
    c.core.gather = "lane";
    EXPECT_EQ(accesses(same, all_lanes), u(ISA_WIDTH));
}

TEST(Caches, DiscardSavesTheWriteBack) {
    Config c = equal_clocks();
    auto body = [&](bool discarded) {
        return run_on(c, [=](std::byte* base, int) {
            isa::timing::store(here, base, 4, stamp{}, stamp{});
            if (discarded)
                isa::timing::discard(here, base, 64, stamp{});
            for (int i = 1; i < 64 * 1024; ++i)
                load(here, base + i * line, 4, stamp{});
        });
    };
    EXPECT_EQ(body(false).memory.writes, 1U);
    EXPECT_EQ(body(true).memory.writes, 0U);
}

TEST(Caches, PrefetchHidesTheMiss) {
    Config c = equal_clocks();
    stamp s;
    Report r = run_on(c, [&](std::byte* base, int) {
        isa::timing::prefetch(here, base, stamp{});
        s = load(here, base, 4, stamp{1000, 1000});
    });
    EXPECT_EQ(s.last, u(1000 + c.l1.latency));
    EXPECT_EQ(r.l1[0].prefetches, 1U);
    EXPECT_EQ(r.l1[0].misses, 0U);
}

// Independent stores that all go through: an entry of the buffer each, until the L2's bank has taken it.
TEST(Caches, WritesThroughWaitForTheBuffer) {
    for (integer entries : {1, 2, 4}) {
        Config c = equal_clocks();
        c.l1.write_policy = "through";
        c.l1.write_back_buffer = entries;
        c.l2.banks = 16;
        auto body = [=](int turns) {
            return run_on(c, [=](std::byte* base, int) {
                for (int t = 0; t < turns; ++t)
                    for (int i = 0; i < 64; ++i)
                        isa::timing::store(here, base + i * line, 4, stamp{}, stamp{});
            });
        };
        Report three = body(3), two = body(2);
        EXPECT_EQ(three.l1[0].written_through, 3 * 64U);
        EXPECT_EQ(three.l1[0].write_backs, 0U);
        EXPECT_EQ((three.cycles - two.cycles) * u(entries), 64 * u(c.l1.latency + c.l2.latency)) << entries;
    }
}

TEST(Caches, WritesAroundBringNoLine) {
    Config c = equal_clocks();
    c.l1.write_miss = "around";
    Report r = run_on(c, [](std::byte* base, int) {
        isa::timing::store(here, base, 4, stamp{}, stamp{}); // around
        stamp s = load(here, base, 4, stamp{1000, 1000});    // comes from the L2
        isa::timing::store(here, base, 4, stamp{}, s);       // hits
    });
    EXPECT_EQ(r.l1[0].written_around, 1U);
    EXPECT_EQ(r.l1[0].misses, 2U);
    EXPECT_EQ(r.l1[0].fills, 1U);
    EXPECT_EQ(r.l2_total().misses, 1U);
}

// Lines a stride apart, each load waiting for the one before: from the fourth on the L1 has asked before.
TEST(Caches, StridesAreFollowedBySite) {
    Config c = equal_clocks();
    c.l1.prefetcher = "stride";
    c.l1.prefetch_degree = 8;
    c.l1.mshrs = c.l2.mshrs = 16;
    const integer stride = 3 * line;
    auto body = [&](bool two_sites) {
        return run_on(c, [=](std::byte* base, int) {
            const site there{"test", 2};
            for (int i = 0; i < 20; ++i) {
                auto at = static_cast<cycle>(1000 * (i + 1));
                load(here, base + i * stride, 4, stamp{at, at});
                load(two_sites ? there : here, base + 65536 - i * stride, 4, stamp{at, at});
            }
        });
    };
    Report r = body(true);
    EXPECT_EQ(r.l1[0].misses, 2 * 3U);
    EXPECT_EQ(r.l1[0].prefetches_useful, 2 * 17U);
    EXPECT_EQ(r.l1[0].prefetches_late, 0U);
    EXPECT_EQ(r.l1[0].prefetches_useless, 2 * 8U);
    EXPECT_EQ(body(false).l1[0].misses, 40U);
}

// The next line is asked for when one misses: it is late by as much as it was asked late.
TEST(Caches, NextLinesComeLate) {
    Config c = equal_clocks();
    c.l1.prefetcher = "next";
    Report r = run_on(c, [](std::byte* base, int) {
        load(here, base, 4, stamp{});
        load(here, base + line, 4, stamp{});
        load(here, base + 2 * line, 4, stamp{1000, 1000});
    });
    EXPECT_EQ(r.l1[0].misses, 1U);
    EXPECT_EQ(r.l1[0].hardware_prefetches, 3U);
    EXPECT_EQ(r.l1[0].prefetches_useful, 2U);
    EXPECT_EQ(r.l1[0].prefetches_late, 1U);
    EXPECT_EQ(r.l1[0].prefetches_useless, 1U);
}

// A thread ends when its last load is there, however long others go on after it and whatever they ask for.
TEST(Caches, ThreadsEndWhenTheirLastLoadsAreThere) {
    const auto finish_of_first = [](int loads_of_other) {
        Config c = equal_clocks();
        c.chip.cores = 2;
        const Report r = run_on(
            c,
            [=](std::byte* base, int w) {
                for (int i = 0; i < (w == 0 ? 1 : loads_of_other); ++i)
                    load(here, base + (w + 2 * i) * line, 4, stamp{});
            },
            2);
        return r.threads.at(0).finish;
    };
    const cycle alone = finish_of_first(0);
    EXPECT_GT(alone, idle_read(equal_clocks()));
    EXPECT_EQ(finish_of_first(20000), alone);
}

TEST(Caches, MissesHaveCauses) {
    Config c = equal_clocks();
    c.sim.miss_causes = "on";
    const integer lines = c.l1.size_bytes / line, sets = lines / c.l1.ways;
    Report r = run_on(c, [=](std::byte* base, int) {
        auto pass = [=](integer count, integer step) {
            for (int i = 0; i < count; ++i)
                load(here, base + i * step * line, 4, stamp{});
        };
        pass(5, sets);      // a line more than the set has ways
        pass(5, sets);      // all gone, with room elsewhere
        pass(lines + 1, 1); // of the five, the last has seen as many others as there is room for
        pass(lines + 1, 1); // a line more than there is room for; only one set misses
    });
    EXPECT_EQ(r.l1[0].compulsory, u(lines + 1));
    EXPECT_EQ(r.l1[0].conflict, 5 + 4U);
    EXPECT_EQ(r.l1[0].capacity, 1 + 5U);
}

} // namespace
} // namespace sim::test
