// What a memory must reach and may not exceed: closed forms of latency and bandwidth.
#include "tests/sim/dram_traffic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim::test {
namespace {

constexpr std::uint64_t far = std::uint64_t{1} << 24; // lines: 1 GiB
const std::vector<std::string> presets = {"ddr3-1600k", "ddr4-2400r", "hbm2"};

double d(integer x) {
    return static_cast<double>(x);
}
void no_refresh(MemoryConfig& m) {
    m.tREFI = 0;
}
testing::AssertionResult close(double value, double expected, double part) {
    if (std::abs(value - expected) <= part * expected)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << value << " is not " << expected << " within " << 100 * part << " %";
}
/// Lines of one bank: `next` row each time.
Source rows_of_one_bank(const Config& c, integer group_step) {
    auto stride = static_cast<std::uint64_t>(c.memory.row_bytes * c.memory.channels * c.memory.ranks *
                                             c.memory.bank_groups * c.memory.banks * group_step);
    return stream(stride);
}

/// A random read in a memory that is mostly idle: with requests `gap` clocks apart, a bank's row is open if
/// it was used since the last refresh; a read that meets a refresh waits for its end.
double idle_latency(const Config& c, double gap) {
    const MemoryConfig& m = c.memory;
    double banks = d(m.channels * m.ranks * m.bank_groups * m.banks);
    double line = d(m.tRCD + m.tCL) + std::max(64 / d(m.bus_bytes * m.burst_length) - 1, 0.0) * d(m.tCCD_L) +
                  d(m.burst_clocks());
    double used = (1 - std::exp(-(d(m.tREFI - m.tRFC)) / gap / banks)) / (d(m.tREFI - m.tRFC) / gap / banks);
    double open = (1 - used) * awake(c);
    // Also waits what comes too late to be read before the refresh: tRC, or its own commands.
    double blocked = d(m.tRFC + std::max(m.tRC, m.tRAS + m.tRP));
    return line + open * d(m.tRP) + blocked * blocked / 2 / d(m.tREFI);
}

TEST(DramBounds, IdleRandomRead) {
    for (const std::string& preset : presets) {
        Config c = memory_of(preset);
        for (double gap : {1000.0, 4000.0}) {
            double each = gap / d(c.memory.channels);
            Outcome r = open_loop(c, each, 100000, random_lines(far));
            EXPECT_TRUE(close(r.latency, idle_latency(c, each), 0.02)) << preset << " " << gap;
        }
    }
}

// With the parameters of Ramulator 2.1's DDR4_8Gb_x8 at DDR4_2400R (tRFC 360 ns): 4 x 64 B every tFAW, less
// refresh.
TEST(DramBounds, RandomReadsOfOneRankAreLimitedByFourActivates) {
    Config c = memory_of("ddr4-2400r", [](MemoryConfig& m) { m.tREFI = 9364, m.tRFC = 433; });
    EXPECT_TRUE(close(closed_loop(c, 64, 200000, random_lines(far)).bandwidth(c), 11.27, 0.02));
    for (const char* preset : {"ddr3-1600k", "ddr4-2400r"}) {
        c = memory_of(preset);
        EXPECT_TRUE(close(closed_loop(c, 64, 200000, random_lines(far)).bytes_per_clock(),
                          4 * 64 / d(c.memory.tFAW) * awake(c), 0.02));
        c = memory_of(preset, no_refresh);
        EXPECT_TRUE(close(closed_loop(c, 64, 200000, random_lines(far)).bytes_per_clock(),
                          4 * 64 / d(c.memory.tFAW), 0.002));
    }
}

// The bus and half a rank switch a burst. Gaps that no later read fits cost a few per cent of it.
TEST(DramBounds, RandomReadsOfTwoRanksAreLimitedByTheBus) {
    Config c = memory_of("ddr4-2400r", [](MemoryConfig& m) { m.ranks = 2, m.tREFI = 0; });
    Outcome r = closed_loop(c, 64, 200000, random_lines(far));
    EXPECT_TRUE(close(r.bandwidth(c), 17.1, 0.05));
    EXPECT_LE(r.bandwidth(c), 17.1 * 1.01);
}

TEST(DramBounds, StreamIsLimitedByTheBus) {
    for (const std::string& preset : presets)
        for (integer channels : {1, 2, 4, 16}) {
            Config c = memory_of(preset, [&](MemoryConfig& m) { m.channels = channels; });
            auto in_flight = static_cast<std::uint64_t>(32 * channels);
            Outcome r = closed_loop(c, in_flight, 20000 * static_cast<std::uint64_t>(channels), stream());
            EXPECT_TRUE(close(r.bytes_per_clock(), peak(c) * awake(c), 0.02)) << preset << " " << channels;
            c.memory.tREFI = 0;
            r = closed_loop(c, in_flight, 20000 * static_cast<std::uint64_t>(channels), stream());
            EXPECT_TRUE(close(r.bytes_per_clock(), peak(c), 0.002)) << preset << " " << channels;
        }
}

TEST(DramBounds, StreamIsNoSlowerThanRandom) {
    for (const std::string& preset : presets)
        for (integer channels : {1, 2, 8})
            for (integer ranks : {1, 2})
                for (std::uint64_t in_flight : {1U, 4U, 16U, 64U}) {
                    Config c =
                        memory_of(preset, [&](MemoryConfig& m) { m.channels = channels, m.ranks = ranks; });
                    in_flight *= static_cast<std::uint64_t>(channels);
                    double random = closed_loop(c, in_flight, 20000, random_lines(far)).bytes_per_clock();
                    double sequential = closed_loop(c, in_flight, 20000, stream()).bytes_per_clock();
                    EXPECT_GE(sequential, random)
                        << preset << " " << channels << " " << ranks << " " << in_flight;
                }
}

TEST(DramBounds, RowConflictsOfOneBankAreTheRowCycleApart) {
    for (const std::string& preset : presets) {
        Config c = memory_of(preset, [](MemoryConfig& m) { m.tREFI = 0, m.channels = 1; });
        c.l2.line_bytes = c.memory.bus_bytes * c.memory.burst_length;
        c.l1.line_bytes = c.l2.line_bytes;
        Outcome r = closed_loop(c, 8, 1000, rows_of_one_bank(c, 1));
        double row_cycle = d(std::max(c.memory.tRC, c.memory.tRCD + c.memory.tRTP + c.memory.tRP));
        EXPECT_EQ(r.clocks, 999 * row_cycle + d(c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks()));
        EXPECT_EQ(r.counters.row_conflicts, 999U);
    }
}

TEST(DramBounds, OneBankGroupIsLimitedByItsColumns) {
    Config c = memory_of("ddr4-2400r", no_refresh);
    Outcome r = closed_loop(c, 16, 120, stream(64 * 4)); // one row
    EXPECT_EQ(r.clocks, 119 * d(c.memory.tCCD_L) + d(c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks()));
}

// Two ranks in turn, row hits: each burst pays the switch.
TEST(DramBounds, RanksInTurnPayTheSwitch) {
    Config c = memory_of("ddr4-2400r", [](MemoryConfig& m) {
        m.ranks = 2, m.tREFI = 0, m.tRTRS = 3, m.mapping = "row:bank:column:group:channel:rank";
    });
    Outcome r = closed_loop(c, 1, 512, stream());
    EXPECT_EQ(r.counters.rank_switches, 511U);
    sim::Memory memory(c, sim::Memory::longest_service(c, 64));
    for (std::uint64_t i = 0; i < 16; ++i)
        memory.read(i * 64, 0);
    cycle before = memory.read(16 * 64, 200), after = memory.read(17 * 64, 200);
    EXPECT_EQ(after - before, 4U + 3U);
}

TEST(DramBounds, RefreshTakesItsShare) {
    for (const std::string& preset : presets) {
        Config c = memory_of(preset);
        Outcome r = closed_loop(c, static_cast<std::uint64_t>(32 * c.memory.channels), 400000, stream());
        for (const MemoryCounters& rank : r.by_rank)
            EXPECT_EQ(rank.refreshes, (rank.last_clock - 1) / static_cast<std::uint64_t>(c.memory.tREFI))
                << preset;
        Config without = memory_of(preset, no_refresh);
        double lost =
            r.clocks -
            closed_loop(without, static_cast<std::uint64_t>(32 * c.memory.channels), 400000, stream()).clocks;
        double refreshes = d(static_cast<integer>(r.by_rank[0].refreshes));
        // A refresh costs its time, and closing and opening the rows around it.
        EXPECT_GE(lost, refreshes * d(c.memory.tRFC));
        EXPECT_LE(lost, refreshes * d(c.memory.tRFC + c.memory.tRC + c.memory.tRP + c.memory.tCL));
    }
}

TEST(DramBounds, ManyRequestsFillHbm) {
    Config c = memory_of("hbm2");
    std::vector<double> reached;
    for (std::uint64_t in_flight : {16U, 64U, 256U, 1024U, 4096U})
        reached.push_back(closed_loop(c, in_flight, 100000, random_lines(far)).bytes_per_clock() / peak(c));
    EXPECT_TRUE(std::is_sorted(reached.begin(), reached.end()));
    EXPECT_LT(reached[0], 0.1); // one request a channel: latency alone
    EXPECT_GT(reached[3], 0.85);
    EXPECT_LE(reached[4], awake(c));
}

TEST(DramBounds, NeverAboveThePeak) {
    for (const std::string& preset : presets)
        for (integer ranks : {1, 2, 4})
            for (double writes : {0.0, 0.3, 1.0}) {
                Config c = memory_of(preset, [&](MemoryConfig& m) { m.ranks = ranks; });
                for (const Source& s : {random_lines(far, writes), random_lines(512, writes), stream()}) {
                    Outcome r = closed_loop(c, static_cast<std::uint64_t>(64 * c.memory.channels), 20000, s);
                    double moved = d(static_cast<integer>(r.counters.busy_clocks));
                    EXPECT_LE(moved, r.clocks * d(c.memory.channels));
                }
            }
}

// Little: the requests in flight are rate times latency.
TEST(DramBounds, RequestsInFlightAreRateTimesLatency) {
    Config c = memory_of("ddr4-2400r");
    Outcome r = closed_loop(c, 48, 200000, random_lines(far));
    EXPECT_TRUE(close(r.lines / r.clocks * r.latency, 48, 0.005));
    EXPECT_TRUE(close(d(static_cast<integer>(r.counters.read_clocks)), r.latency * r.lines, 1e-9));
}

TEST(DramBounds, LongerTimesAreNeverFaster) {
    struct Timing {
        const char* name;
        integer MemoryConfig::*member;
        integer more;
    };
    using M = MemoryConfig;
    const Timing timings[] = {
        {"tRCD", &M::tRCD, 8},      {"tRP", &M::tRP, 8},        {"tRAS", &M::tRAS, 30},
        {"tRC", &M::tRC, 30},       {"tCL", &M::tCL, 8},        {"tCCD_L", &M::tCCD_L, 6},
        {"tRRD_S", &M::tRRD_S, 8},  {"tRRD_L", &M::tRRD_L, 12}, {"tFAW", &M::tFAW, 20},
        {"tRTP", &M::tRTP, 30},     {"tWR", &M::tWR, 30},       {"tWTR_S", &M::tWTR_S, 20},
        {"tWTR_L", &M::tWTR_L, 30}, {"tRTW", &M::tRTW, 16},     {"tRTRS", &M::tRTRS, 6},
        {"tRFC", &M::tRFC, 500}};
    for (const Timing& t : timings) {
        auto change = [&](integer more) {
            return memory_of("ddr4-2400r", [&](MemoryConfig& m) {
                m.ranks = 2;
                m.*t.member += more;
                m.tRC = std::max(m.tRC, m.tRAS);
                m.tRRD_L = std::max(m.tRRD_L, m.tRRD_S);
                m.tWTR_L = std::max(m.tWTR_L, m.tWTR_S);
            });
        };
        auto clocks = [&](integer more, std::uint64_t in_flight) {
            return closed_loop(change(more), in_flight, 40000, random_lines(far, 0.3)).clocks;
        };
        // Schedules that differ in one place differ everywhere: half a per cent is their spread.
        EXPECT_GE(clocks(t.more, 4), clocks(0, 4) * 0.995) << t.name;
        EXPECT_GE(clocks(t.more, 32), clocks(0, 32) * 0.995) << t.name;
    }
}

} // namespace
} // namespace sim::test
