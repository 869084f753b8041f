// The controller with queues (dram_controller.h): closed forms of bandwidth and latency, and each policy by
// its effect.
#include "sim/memory/dram_bounds.h"
#include "sim/memory/dram_load.h"
#include "sim/memory/waiting_memory.h"
#include "tests/sim/dram_traffic.h"
#include "tests/sim/machines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim::test {
namespace {

using M = MemoryConfig;
constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;

double d(integer x) {
    return static_cast<double>(x);
}
testing::AssertionResult close(double value, double expected, double part) {
    if (std::abs(value - expected) <= part * expected)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << value << " is not " << expected << " within " << 100 * part << " %";
}
DramOutcome saturated(const Config& c, const std::string& stream, std::uint64_t requests = 100000,
                      std::uint64_t in_flight = 64) {
    return run_dram_queued(c, make_dram_stream(stream, c, gibibyte, 4096, 1),
                           {0, in_flight * u(c.memory.channels), requests, 1});
}
double gigabytes(const Config& c, const DramOutcome& o) {
    return o.bytes_per_clock * 1e3 / d(c.memory.clock_ps);
}

/// One memory, one request at a time; a clock is a cycle.
struct Bench {
    explicit Bench(const Config& c) : memory(in_memory_clocks(c)) { memory.set_log(&log); }
    /// Lets the memory work to the end; the clocks of all answers since the last call, by id.
    std::map<std::uint64_t, cycle> answers(cycle until) {
        memory.advance_to(until);
        std::map<std::uint64_t, cycle> out;
        for (const QueuedMemory::Done& done : memory.done())
            out[done.id] = done.at;
        memory.done().clear();
        return out;
    }
    QueuedMemory memory;
    std::vector<DramCommand> log;
};
std::uint64_t row_stride(const Config& c) { // to the next row of a bank
    return u(c.memory.row_bytes * c.memory.channels * c.memory.ranks * c.memory.bank_groups * c.memory.banks);
}
Config ddr4(const std::function<void(M&)>& change = {}) {
    return memory_of("ddr4-2400r", [&](M& m) {
        m.tREFI = 0;
        if (change)
            change(m);
    });
}

TEST(DramQueued, SaturatedStreamsReachTheClosedForms) {
    for (const MemoryConfig& preset : memory_presets())
        for (integer refresh : {0, 1}) {
            auto compare = [&](const char* stream, integer channels, std::uint64_t requests,
                               std::uint64_t in_flight) {
                Config c = memory_of(preset.preset, [&](M& m) {
                    m.tREFI *= refresh, m.channels = channels, m.age_cap = 0;
                    m.read_queue = static_cast<integer>(in_flight);
                });
                DramBound bound = dram_bandwidth_bound(c, stream);
                DramOutcome o = saturated(c, stream, requests * u(channels), in_flight);
                // Where every clock of tRRD counts, an activate that meets a column command on the one
                // command bus is late.
                bool late = bound.by.find("tRRD") != std::string::npos && c.memory.command_buses == 1;
                EXPECT_TRUE(close(o.bytes_per_clock, bound.bytes_per_clock, late ? 0.1 : 0.02))
                    << preset.preset << " " << stream << " " << bound.by;
                EXPECT_LE(o.bytes_per_clock, bound.bytes_per_clock * 1.01) << preset.preset << " " << stream;
            };
            compare("sequential", preset.channels, 20000, 64);
            compare("random", 1, 50000, 512); // so many that hardly a bank is ever without
            compare("hot-bank", 1, 5000, 4);  // so few that no row is wanted twice
        }
}

// Figures of 4 x 64 B every tFAW, less refreshes of 433 in 9364 clocks, and of a bus of 4 clocks a burst with
// half a rank switch, which a scheduler that prefers what is ready may beat, but not the bus.
TEST(DramQueued, RandomReadsOfOneAndTwoRanks) {
    Config c = memory_of("ddr4-2400r", [](M& m) { m.tREFI = 9364, m.tRFC = 433; });
    EXPECT_TRUE(close(gigabytes(c, saturated(c, "random", 200000)), 11.27, 0.02));
    c.memory.ranks = 2;
    c.memory.tREFI = 0;
    double two = gigabytes(c, saturated(c, "random", 200000));
    EXPECT_GT(two, 17.1);
    EXPECT_LT(two, 19.21);
}

TEST(DramQueued, IdleRandomRead) {
    for (const MemoryConfig& preset : memory_presets()) {
        Config c = memory_of(preset.preset);
        for (double gap : {2000.0, 8000.0}) {
            double each = gap / d(c.memory.channels);
            DramOutcome o =
                run_dram_queued(c, make_dram_stream("random", c, gibibyte, 0, 1), {each, 1000, 100000, 1});
            EXPECT_TRUE(close(o.mean, dram_idle_latency(c, each), 0.02)) << preset.preset << " " << gap;
        }
    }
}

TEST(DramQueued, SequentialIsNoSlowerThanRandom) {
    for (const MemoryConfig& preset : memory_presets())
        for (integer ranks : {1, 2})
            for (std::uint64_t in_flight : {1U, 4U, 16U, 64U}) {
                Config c = memory_of(preset.preset, [&](M& m) { m.ranks = ranks; });
                // A stream waits for the refresh of its rank, random reads go to another.
                EXPECT_GE(saturated(c, "sequential", 20000, in_flight).bytes_per_clock,
                          saturated(c, "random", 20000, in_flight).bytes_per_clock * (ranks == 1 ? 1 : 0.99))
                    << preset.preset << " " << ranks << " " << in_flight;
            }
}

// A refresh costs its time, and closing and opening the rows around it.
TEST(DramQueued, RefreshTakesItsShare) {
    for (const MemoryConfig& preset : memory_presets()) {
        Config c = memory_of(preset.preset), without = memory_of(preset.preset, [](M&m) { m.tREFI = 0; });
        DramOutcome with = saturated(c, "sequential", 200000),
                    none = saturated(without, "sequential", 200000);
        for (std::size_t i = 0; i < with.by_rank.size(); ++i) {
            std::uint64_t ranks = u(c.memory.ranks), rank = i % ranks, last = 0;
            for (std::size_t r = 0; r < ranks; ++r)
                last = std::max(last, with.by_rank[i - rank + r].last_clock);
            EXPECT_EQ(with.by_rank[i].refreshes,
                      (last - 1 - u(c.memory.tREFI) * rank / ranks) / u(c.memory.tREFI))
                << preset.preset;
        }
        EXPECT_EQ(none.counters.refreshes, 0U);
        double lost = with.clocks - none.clocks, refreshes = static_cast<double>(with.by_rank[0].refreshes);
        EXPECT_GE(lost, refreshes * d(c.memory.tRFC) * 0.98) << preset.preset;
        EXPECT_LE(lost, refreshes * d(c.memory.tRFC + c.memory.tRC + c.memory.tRP + c.memory.tCL))
            << preset.preset;
    }
}

TEST(DramQueued, OneReadTakesItsCommands) {
    Config c = ddr4();
    Bench bench(c);
    ASSERT_TRUE(bench.memory.read(0, 0, 100));             // empty
    ASSERT_TRUE(bench.memory.read(1, 64 * 4, 300));        // hit
    ASSERT_TRUE(bench.memory.read(2, row_stride(c), 500)); // conflict
    auto done = bench.answers(1000);
    EXPECT_EQ(done.at(0), 100 + 16 + 16 + 4U);
    EXPECT_EQ(done.at(1), 300 + 16 + 4U);
    EXPECT_EQ(done.at(2), 500 + 16 + 16 + 16 + 4U);
    EXPECT_EQ(bench.memory.next_event(), QueuedMemory::never);
    MemoryCounters n = bench.memory.counters();
    EXPECT_EQ(n.row_empties, 1U);
    EXPECT_EQ(n.row_hits, 1U);
    EXPECT_EQ(n.row_conflicts, 1U);
    EXPECT_EQ(n.read_clocks, 36 + 20 + 52U);
    EXPECT_EQ(n.queue_clocks, 0U);
}

// Reads of rows A B A B of one bank: first ready serves both of A, then both of B.
TEST(DramQueued, FirstReadyServesTheOpenRowFirst) {
    for (const char* scheduler : {"fr-fcfs", "fcfs"}) {
        Config c = ddr4([&](M& m) { m.scheduler = scheduler; });
        Bench bench(c);
        for (std::uint64_t i = 0; i < 4; ++i)
            ASSERT_TRUE(bench.memory.read(i, (i % 2) * row_stride(c) + i / 2 * 64 * 4, 0));
        auto done = bench.answers(1000);
        bool first_ready = std::string(scheduler) == "fr-fcfs";
        EXPECT_EQ(done.at(0), 36U);
        EXPECT_EQ(done.at(2), first_ready ? 36 + 6U : 36 + 2 * 55U);
        EXPECT_EQ(done.at(1), 36 + 55U);
        EXPECT_EQ(done.at(3), first_ready ? 36 + 55 + 6U : 36 + 3 * 55U);
        EXPECT_EQ(bench.memory.counters().activates, first_ready ? 2U : 4U);
    }
}

// Hits of one row keep coming faster than they are served; a read of another row must wait for the age cap
// only.
TEST(DramQueued, NobodyStarves) {
    auto waits = [](integer cap) {
        Config c = ddr4([&](M& m) { m.age_cap = cap, m.read_queue = 16; });
        Bench bench(c);
        std::uint64_t column = 0;
        EXPECT_TRUE(bench.memory.read(0, 0, 0));
        EXPECT_TRUE(bench.memory.read(1, row_stride(c), 1));
        std::map<std::uint64_t, cycle> done;
        for (cycle t = 2; t < 3000; ++t) {
            while (bench.memory.read(
                2, ++column % 128 * 64 * 4 % static_cast<std::uint64_t>(c.memory.row_bytes * 4), t))
                ;
            for (auto [id, at] : bench.answers(t + 1))
                done.emplace(id, at);
        }
        return done.count(1) == 1 ? done.at(1) : 0;
    };
    EXPECT_EQ(waits(0), 0U);
    for (integer cap : {200, 500, 1000}) {
        // The last hit, its precharge, and opening the row.
        EXPECT_GE(waits(cap), u(cap) + 9);
        EXPECT_LE(waits(cap), 1 + u(cap) + 6 + 9 + 16 + 16 + 16 + 4) << cap;
    }
}

TEST(DramQueued, FullQueuesRefuse) {
    Config c = ddr4([](M& m) { m.read_queue = 3, m.write_queue = 2, m.write_high = 2, m.write_low = 0; });
    Bench bench(c);
    for (std::uint64_t i = 0; i < 3; ++i)
        EXPECT_TRUE(bench.memory.read(i, i * row_stride(c), 0));
    EXPECT_FALSE(bench.memory.read(3, 3 * row_stride(c), 0));
    EXPECT_TRUE(bench.memory.write(4 * row_stride(c), 0));
    EXPECT_EQ(bench.memory.counters().reads, 3U);
    // Room as soon as the first column command is out.
    EXPECT_FALSE(bench.memory.read(3, 3 * row_stride(c), 16));
    EXPECT_TRUE(bench.memory.read(3, 3 * row_stride(c), 17));
    bench.memory.finish();
    EXPECT_EQ(bench.memory.counters().write_bursts, 1U);
    EXPECT_EQ(bench.memory.counters().read_bursts, 4U);
}

TEST(DramQueued, WritesWaitForTheHighWatermark) {
    Config c = ddr4([](M& m) { m.write_queue = 16, m.write_high = 8, m.write_low = 2; });
    Bench bench(c);
    // Reads all the time, so that writes are sent at the high watermark only.
    std::uint64_t next = 0;
    std::vector<std::uint64_t> writes_after;
    for (cycle t = 0; t < 4000; ++t) {
        if (t % 4 == 0)
            bench.memory.read(t, gibibyte / 2 + 64 * next++, t);
        if (t % 100 == 0) {
            ASSERT_TRUE(bench.memory.write(t / 100 * 64, t));
        }
    }
    MemoryCounters n = bench.memory.counters();
    // 40 writes: the 8th, and every 6th from there, sends six.
    EXPECT_EQ(n.batches, 6U);
    EXPECT_EQ(n.write_bursts, 36U);
    EXPECT_EQ(n.turnarounds, 12U);
    bench.memory.finish();
    EXPECT_EQ(bench.memory.counters().write_bursts, 40U);
}

TEST(DramQueued, QueuedWritesAnswerReadsAndTakeOthersIn) {
    Config c = ddr4();
    Bench bench(c);
    EXPECT_TRUE(bench.memory.write(640, 0));
    EXPECT_TRUE(bench.memory.write(640, 5));
    EXPECT_TRUE(bench.memory.read(7, 640, 10));
    // No sooner than the shortest.
    EXPECT_EQ(bench.answers(10), (std::map<std::uint64_t, cycle>{{7, 10 + QueuedMemory::shortest_read(c)}}));
    EXPECT_EQ(bench.memory.counters().forwarded, 1U);
    EXPECT_EQ(bench.memory.counters().merged, 1U);
    bench.memory.finish();
    EXPECT_EQ(bench.memory.counters().write_bursts, 1U);
    EXPECT_EQ(bench.memory.counters().read_bursts, 0U);
}

// One that the full queue has refused is held back from when it goes in.
TEST(DramQueued, AReadThatWaitedIsNoSoonerThanTheShortest) {
    Config c = ddr4();
    c.memory.read_queue = 1;
    WaitingMemory memory(c);
    memory.write(0, 640, 0);
    memory.read(1, 4 * gibibyte / 8, 1);
    memory.read(2, 640, 2);
    EXPECT_TRUE(memory.busy());
    cycle decided = 0;
    while (memory.reads().size() < 2)
        memory.advance_to(++decided);
    EXPECT_EQ(memory.queues().counters().forwarded, 1U);
    for (const WaitingMemory::Done& d : memory.reads())
        EXPECT_GE(d.at + 1, d.id == 2 ? decided + QueuedMemory::shortest_read(c) : 0);
    EXPECT_GT(decided, 2U);
}

// Two reads of a bank, far apart: of one row and of two, by page policy.
TEST(DramQueued, PagePolicies) {
    struct Case {
        const char* policy;
        cycle apart, same, other; // latency of the second
    };
    for (const Case& p : {Case{"open", 150, 20, 52},
                          {"closed", 150, 36, 36},
                          {"timeout", 150, 20, 52},
                          {"timeout", 400, 36, 36}})
        for (bool same : {true, false}) {
            Config c = ddr4([&](M& m) { m.page_policy = p.policy, m.page_timeout = 300; });
            Bench bench(c);
            EXPECT_TRUE(bench.memory.read(0, 0, 0));
            EXPECT_TRUE(bench.memory.read(1, same ? 64 * 4 : row_stride(c), p.apart));
            EXPECT_EQ(bench.answers(2000).at(1) - p.apart, same ? p.same : p.other)
                << p.policy << " " << p.apart;
            // The same of the controller that answers at once.
            sim::Memory memory(in_memory_clocks(c), 0);
            memory.read(0, 0);
            EXPECT_EQ(memory.read(same ? 64 * 4 : row_stride(c), p.apart) - p.apart, same ? p.same : p.other)
                << p.policy << " " << p.apart;
        }
}

// While there are requests, refreshes wait, eight at most; then they are made up for.
TEST(DramQueued, RefreshesWaitForRequests) {
    auto run = [](integer postponed, cycle busy) {
        Config c = memory_of("ddr4-2400r", [&](M& m) { m.refresh_postponed = postponed; });
        Bench bench(c);
        std::uint64_t line = 0;
        for (cycle t = 0; t < busy; t += 5)
            bench.memory.read(0, 64 * line++, t);
        bench.answers(busy + 20000);
        std::vector<Clock> at;
        for (const DramCommand& x : bench.log)
            if (x.kind == DramCommand::Kind::refresh)
                at.push_back(x.at);
        return at;
    };
    EXPECT_EQ(run(0, 40000).front(), 9363U);
    std::vector<Clock> at = run(8, 40000);
    EXPECT_GT(at.front(), 40000U);
    ASSERT_EQ(at.size(), 6U);
    for (std::size_t i = 1; i < 4; ++i)
        EXPECT_EQ(at[i] - at[i - 1], 421U);
    at = run(8, 200000);
    EXPECT_EQ(at.front(), 9 * 9363U);
    EXPECT_EQ(run(8, 0).front(), 9363U);
}

// Banks that are not refreshed go on: less is lost than when all stop.
TEST(DramQueued, RefreshOfSingleBanksLosesLess) {
    Config all = memory_of("hbm2"),
           single = memory_of("hbm2", [](MemoryConfig&m) { m.refresh = "per-bank"; });
    Config none = memory_of("hbm2", [](M& m) { m.tREFI = 0; });
    double a = saturated(all, "sequential").bytes_per_clock,
           s = saturated(single, "sequential").bytes_per_clock,
           n = saturated(none, "sequential").bytes_per_clock;
    EXPECT_TRUE(close(a, n * dram_awake(all.memory), 0.02));
    EXPECT_GT(s, a * 1.02);
    EXPECT_LE(s, n);
    DramOutcome random = saturated(single, "random");
    EXPECT_GT(random.bytes_per_clock, saturated(all, "random").bytes_per_clock);
    EXPECT_LT(random.bytes_per_clock, saturated(none, "random").bytes_per_clock);
    for (const MemoryCounters& rank : random.by_rank) // each bank once in tREFI
        EXPECT_NEAR(static_cast<double>(rank.refreshes),
                    (static_cast<double>(rank.last_clock) / d(single.memory.tREFI) - 1) * 16, 1);
}

// What is decided does not depend on how often the simulation looks.
TEST(DramQueued, LookingChangesNothing) {
    for (const char* preset : {"ddr4-2400r", "hbm2"}) {
        Config c = memory_of(
            preset, [](M& m) { m.age_cap = 300, m.page_policy = "timeout", m.refresh_postponed = 2; });
        auto run = [&](unsigned looks) {
            Bench bench(c);
            DramStream stream = make_dram_stream("two-to-one", c, 1 << 20, 0, 3);
            std::mt19937 random(5);
            cycle t = 0;
            std::map<std::uint64_t, cycle> done;
            for (std::uint64_t i = 0; i < 5000; ++i) {
                cycle next = t + random() % 60;
                for (; looks != 0 && t < next; t += looks) {
                    bench.memory.next_event();
                    for (auto [id, at] : bench.answers(t))
                        done[id] = at;
                }
                t = next;
                DramRequest r = stream();
                r.write ? bench.memory.write(r.address, t) : bench.memory.read(i, r.address, t);
            }
            bench.memory.finish();
            for (auto [id, at] : bench.answers(t))
                done[id] = at;
            return done;
        };
        auto seldom = run(0);
        EXPECT_EQ(run(1), seldom) << preset;
        EXPECT_EQ(run(7), seldom) << preset;
    }
}

// Little: the reads in flight are rate times latency.
TEST(DramQueued, RequestsInFlightAreRateTimesLatency) {
    Config c = memory_of("ddr4-2400r");
    DramOutcome o = saturated(c, "random", 200000, 48);
    EXPECT_TRUE(close(static_cast<double>(o.reads) / o.clocks * o.mean, 48, 0.005));
    EXPECT_LE(static_cast<double>(o.counters.busy_clocks), o.clocks);
}

} // namespace
} // namespace sim::test
