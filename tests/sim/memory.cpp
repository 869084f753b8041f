// Closed forms of the memory system, and caches against a model of their own.
#include "tests/sim/machines.h"

#include <algorithm>
#include <list>
#include <random>

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

/// Least recently used, written for this test alone: a list a set.
class Oracle {
public:
    Oracle(std::size_t sets, std::size_t ways) : sets_(sets), ways_(ways) {}
    std::uint64_t misses = 0, write_backs = 0;
    std::vector<std::pair<std::uint64_t, bool>> out; // what it asks of the next level: (line, write)

    void access(std::uint64_t number, bool write) {
        auto& set = sets_[number % sets_.size()];
        auto found = std::find_if(set.begin(), set.end(), [&](const auto& e) { return e.first == number; });
        if (found != set.end()) {
            set.splice(set.begin(), set, found);
            set.front().second |= write;
            return;
        }
        ++misses;
        if (set.size() == ways_) {
            if (set.back().second) {
                ++write_backs;
                out.emplace_back(set.back().first, true);
            }
            set.pop_back();
        }
        out.emplace_back(number, false);
        set.emplace_front(number, write);
    }

private:
    std::vector<std::list<std::pair<std::uint64_t, bool>>> sets_;
    std::size_t ways_;
};

TEST(Caches, EqualASimpleModel) {
    std::mt19937 random(7);
    for (auto [size, ways, l2_size, l2_ways] : {std::array<integer, 4>{1024, 1, 4096, 1},
                                                {1024, 2, 8192, 4},
                                                {4096, 4, 16384, 8},
                                                {1536, 3, 12288, 6},
                                                {512, 8, 131072, 16}}) {
        Config c = equal_clocks();
        c.l1.size_bytes = size;
        c.l1.ways = ways;
        c.l2.size_bytes = l2_size;
        c.l2.ways = l2_ways;
        std::vector<std::pair<std::uint32_t, bool>> stream;
        for (int i = 0; i < 100000; ++i) {
            std::uint32_t span = random() % 4 == 0 ? 4096 : 64; // lines: most are near
            stream.emplace_back(random() % (span * 16) * 4, random() % 3 == 0);
        }
        Report r = run_on(c, [&](std::byte* base, int) {
            for (auto [offset, write] : stream)
                if (write)
                    isa::timing::store(here, base + offset, 4, stamp{}, stamp{});
                else
                    load(here, base + offset, 4, stamp{});
        });
        Oracle l1(u(size / (ways * line)), u(ways)), l2(u(l2_size / (l2_ways * line)), u(l2_ways));
        for (auto [offset, write] : stream)
            l1.access(offset / u(line), write);
        for (auto [number, write] : l1.out)
            l2.access(number, write);
        EXPECT_EQ(r.l1[0].misses, l1.misses);
        EXPECT_EQ(r.l1[0].write_backs, l1.write_backs);
        EXPECT_EQ(r.l2_total().reads + r.l2_total().writes, l1.out.size());
        EXPECT_EQ(r.l2_total().misses, l2.misses);
        EXPECT_EQ(r.l2_total().write_backs, l2.write_backs);
    }
}

} // namespace
} // namespace sim::test
